from build123d import Align, Box, Cylinder, Pos, Rot

TOP = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    cup = Pos(Z=-d.drop) * (Cylinder(d.radius, d.high, align=TOP) - Pos(Z=-d.top) * Cylinder(d.radius - d.wall, d.high, align=TOP))
    for side in (-1, 1):
        y = side * (d.t + d.ear_thick) / 2
        cup += Pos(0, y, -(d.drop + 1) / 2) * Box(d.ear, d.ear_thick, d.drop + 1)
        cup += Pos(0, y) * Rot(X=90) * Cylinder(d.ear / 2, d.ear_thick)
    return part.made(cup)
