from build123d import Align, Cylinder

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Cylinder(d["pad_radius"], d["pad"], align=LOW)
    return body, {"glue_0": {"o": (0, 0, d["pad"]), "z": (0, 0, 1), "x": (1, 0, 0)}}
