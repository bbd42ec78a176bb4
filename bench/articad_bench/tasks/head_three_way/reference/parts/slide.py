from build123d import Align, Box, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(0, 0, 0.2) * (Box(d["length"], d["slot"] - 1, 7, align=LOW) + Cylinder(3, 13, align=LOW))
    return body, {"slide": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}}
