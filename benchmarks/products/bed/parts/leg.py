from build123d import Align, Box, Cylinder, Pos, Rot

TOP = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    body = Pos(Z=-d.long + d.bar) * Box(2 * d.x, d.thick, d.bar, align=TOP)
    for side in (-1, 1):
        body += Pos(side * d.x) * (Box(d.wide, d.thick, d.long, align=TOP) + Rot(Y=90) * Cylinder(d.eye, d.wide))
    return part.made(body)
