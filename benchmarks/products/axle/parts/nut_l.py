from build123d import Pos, RegularPolygon, Rot, extrude


def build(part):
    d = part.dimensions
    return part.made(Rot(Y=-90) * extrude(RegularPolygon(d.radius, 6), d.thick))
