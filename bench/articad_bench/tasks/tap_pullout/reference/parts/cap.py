from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
LEFT_LOW = (Align.MIN, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Cylinder(d["body_radius"], 26, align=LOW) - Cylinder(8 + d["clearance"], 14.5, align=LOW)
    body -= Pos(3, 0, 15.5) * Box(60, 12, 20, align=LEFT_LOW)
    body += Pos(10, 0, 20) * Rot(X=90) * Cylinder(d["pin_radius"], 24)

    return body, {"mix": {"o": (0, 0, -0.5), "z": (0, 0, 1), "x": (1, 0, 0)}, "flow": {"o": (10, 0, 20), "z": (0, -1, 0), "x": (1, 0, 0)}}
