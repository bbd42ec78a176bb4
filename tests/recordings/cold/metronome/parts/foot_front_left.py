from build123d import Align, Axis, Cylinder, fillet


def build(part):
    d = part.dimensions
    disc = Cylinder(d["radius"], d["height"], align=(Align.CENTER, Align.CENTER, Align.MIN))
    shape = fillet(disc.edges().group_by(Axis.Z)[0], radius=d["edge_radius"])
    return shape, {"seat": {"o": (0, 0, d["height"]), "z": (0, 0, 1), "x": (1, 0, 0)}}
