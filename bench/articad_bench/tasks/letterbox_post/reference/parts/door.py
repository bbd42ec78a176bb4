from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(0, 0, -2) * Box(d["width"] - 2 * d["wall"] - 1, 4, d["door_height"], align=(Align.CENTER, Align.CENTER, Align.MIN))
    body += Rot(Y=90) * Cylinder(d["pin_radius"], d["width"] - 1)
    body += Pos(0, -2, d["door_height"] - 25) * Rot(X=90) * Cylinder(8, 10, align=LOW)

    return body, {"door": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}}
