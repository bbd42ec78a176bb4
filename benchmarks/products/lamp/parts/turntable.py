from build123d import Box, Cylinder, Pos


def build(part):
    d = part.dimensions
    return part.made(Pos(Z=d.disc / 2) * Cylinder(d.radius, d.disc) + Pos(Z=d.high / 2) * Box(d.wide, d.t, d.high))
