from build123d import Align, Box, Cylinder, Pos, Rot

TOP = (Align.CENTER, Align.MAX, Align.MAX)


def build(part):
    d = part.dimensions
    body = Pos(0, d.head, d.thick / 2) * Box(d.wide, d.long, d.thick, align=TOP)
    for side in (-1, 1):
        lug = Box(d.lug_wide, d.lug, d.lug / 2 - d.lw, align=(Align.CENTER, Align.CENTER, Align.MAX))
        body += Pos(side * (d.lug_x + d.lug_wide / 2), -d.lu) * lug
    body -= Pos(d.wide / 2) * Rot(Y=90) * Cylinder(d.fold_bore / 2, 2 * (d.fold_depth - 2))
    return part.made(body)
