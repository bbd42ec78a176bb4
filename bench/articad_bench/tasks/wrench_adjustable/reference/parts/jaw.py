from build123d import Align, Box, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
LEFT_LOW = (Align.MIN, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = (
        Pos(d["rod_x"], 0, -40) * Cylinder(d["rod"], 60, align=LOW)
        + Pos(d["rod_x"] - 6, 0, -45) * Box(66 - d["rod_x"], d["thick"], 12, align=LEFT_LOW)
        + Pos(32, 0, -40) * Box(28, d["thick"], 40 + d["face"], align=LEFT_LOW)
    )
    return body, {"jaw": {"o": (0, 0, 0), "z": (0, 0, -1), "x": (1, 0, 0)}}
