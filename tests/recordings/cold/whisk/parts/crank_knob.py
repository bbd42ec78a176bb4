from build123d import Align, Cylinder, GeomType, Pos, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    shape = Cylinder(d["radius"], d["height"], align=UP)
    shape = fillet(shape.edges().filter_by(GeomType.CIRCLE), radius=d["edge_round"])
    shape -= Pos(0, 0, -1) * Cylinder(d["bore_radius"], d["height"] + 2, align=UP)
    return shape, {"bore": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
