from build123d import Axis, Cylinder, Pos, chamfer


def build(part):
    d = part.dimensions
    head = Pos(Z=d.thick / 2) * Cylinder(d.radius, d.thick)
    return part.made(chamfer(head.edges().sort_by(Axis.Z)[-1], d.thick / 2))
