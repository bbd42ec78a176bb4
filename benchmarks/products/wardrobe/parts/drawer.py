from build123d import Align, Box, Pos

F = Align.CENTER, Align.MIN, Align.MIN


def build(part):
    d = part.dimensions
    tray = Box(d.width, d.length, d.side_height, align=F) + Box(d.width, d.thick, d.height, align=F)
    tray -= Pos(0, d.thick, d.floor) * Box(d.width - 2 * d.side, d.length - d.thick - d.side, d.height, align=F)
    groove = Box(2 * d.groove_depth, d.length, d.groove_height, align=(Align.CENTER, Align.MIN, Align.CENTER))
    for x in (-d.width / 2, d.width / 2):
        tray -= Pos(x, d.thick, d.groove_z) * groove
    return part.made(tray)
