from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(0, 0, -14) * Cylinder(d["button"], 20, align=LOW)
    return body, {"thumb": {"o": (0, 0, 0), "z": (0, 0, -1), "x": (1, 0, 0)}}
