from build123d import Align, Cylinder, Pos, RectangleRounded, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    height = d["height"]
    shape = extrude(RectangleRounded(d["side"], d["side"], d["edge_radius"]), amount=height)
    shape += Pos(0, 0, height - 1) * Cylinder(d["peg_radius"], d["peg_length"] + 1, align=UP)
    return shape, {"top": {"o": (0, 0, height), "z": (0, 0, 1), "x": (1, 0, 0)}}
