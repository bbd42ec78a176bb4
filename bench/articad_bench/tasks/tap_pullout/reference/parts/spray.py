from build123d import Align, Cylinder

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    body = Cylinder(d["head_radius"], 50, align=HIGH) + Cylinder(d["hose_radius"], d["hose_length"], align=LOW)

    return body, {"spray": {"o": (0, 0, 0.5), "z": (0, 0, -1), "x": (1, 0, 0)}}
