from build123d import Cylinder, Pos, Rot


def build(part):
    d = part.dimensions
    tube = Cylinder(d.radius, d.length) - Cylinder(d.radius - d.wall, d.length)
    return part.made(Pos(d.length / 2) * Rot(Y=90) * tube)
