from build123d import Align, Cylinder, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Rot(Y=-90) * Cylinder(d["bolt"], d["rod_length"], align=LOW)
    return body, {"bolt": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}}
