from build123d import Cylinder, Pos


def build(part):
    d = part.dimensions
    return part.made(Pos(Z=-d.thick / 2) * Cylinder(d.radius, d.thick))
