from build123d import Cylinder, Pos, Rot


def build(part):
    d = part.dimensions
    return part.made(Pos(-d.length / 2) * Rot(Y=90) * Cylinder(d.radius, d.length))
