from build123d import Cylinder, Pos, Rot


def build(part):
    d = part.dimensions
    return part.made(Pos(Y=d.thick / 2) * Rot(X=90) * Cylinder(d.radius, d.thick))
