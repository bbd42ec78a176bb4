from build123d import Align, Cylinder

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Cylinder(d["radius"], d["height"], align=LOW) + Cylinder(d["pan_pin"], d["height"] + 20, align=LOW)
    return body, {"pan": {"o": (0, 0, 12), "z": (0, 0, 1), "x": (1, 0, 0)}}
