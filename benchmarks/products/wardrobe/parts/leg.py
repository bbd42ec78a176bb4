from build123d import Cone, Pos


def build(part):
    d = part.dimensions
    return part.made(Pos(Z=-d.height / 2) * Cone(d.bottom, d.top, d.height))
