from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
LEFT = (Align.MIN, Align.CENTER, Align.CENTER)


def build(part):
    d = part.dimensions
    body = Pos(30, 0, 0) * Box(170, 8, 3)
    for y in (-30, 30):
        body += Pos(0, y, 0) * Box(130, 20, 3)
    body += (
        Pos(60, 0, 0) * Box(12, 80, 3)
        + Pos(100, 0, 0) * Rot(Y=90) * Cylinder(d["stem"], d["length"] / 2 - 90, align=LOW)
        + Pos(d["length"] / 2 + 6, 0, 0) * Box(20, 30, 14, align=LEFT)
    )

    return body, {"lever": {"o": (0, 0, 0), "z": (0, 0, -1), "x": (1, 0, 0)}}
