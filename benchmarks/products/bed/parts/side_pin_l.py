from build123d import Cylinder, Pos, Rot


def build(part):
    d = part.dimensions
    side = -1 if part.name == "side_pin_l" else 1
    return part.made(Pos(side * d.thick / 2) * Rot(Y=90) * Cylinder(d.radius, d.thick))
