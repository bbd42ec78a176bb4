from build123d import Align, Cylinder, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Rot(Y=90) * Cylinder(d["anvil_radius"], d["pin_length"], align=LOW)
    return body, {"anvil": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}}
