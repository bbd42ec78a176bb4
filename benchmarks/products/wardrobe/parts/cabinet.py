from build123d import Align, Box, Cylinder, Pos, Rot

F = Align.CENTER, Align.MIN, Align.MIN


def build(part):
    d = part.dimensions
    w, deep = d.width - 2 * d.board, d.depth - d.back
    body = Box(d.width, d.depth, d.height, align=F)
    body -= Pos(0, 0, d.board) * Box(w, deep, d.divider_top - 2 * d.board, align=F)
    body -= Pos(0, 0, d.divider_top) * Box(w, deep, d.height - d.board - d.divider_top, align=F)
    body += Pos(0, d.shelf_front, d.shelf_z) * Box(w, deep - d.shelf_front, d.board, align=F)
    body += Pos(0, d.stop_y, d.height - d.board - d.stop_height) * Box(d.stop_width, d.board, d.stop_height, align=F)
    rail = Box(d.rail_width, deep - d.rail_front, d.rail_height, align=(Align.CENTER, Align.MIN, Align.CENTER))
    for z in (d.low_z, d.high_z):
        for side in (-1, 1):
            body += Pos(side * (w - d.rail_width) / 2, d.rail_front, z) * rail
    body -= Pos(0, d.rail_y, d.rail_z) * Rot(Y=90) * Cylinder(d.rail_radius, w + 2 * d.rail_seat)
    return part.made(body)
