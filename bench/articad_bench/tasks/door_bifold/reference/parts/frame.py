from build123d import Align, Box, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
LEFT_LOW = (Align.MIN, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length = 2 * d["leaf"] + 110
    body = (
        Pos(-50, 0, -20) * Box(length, 60, 20, align=LEFT_LOW)
        + Pos(-50, 0, d["lintel_z"]) * Box(length, 60, 40, align=LEFT_LOW)
        + Pos(-50, 0, -20) * Box(30, 60, d["lintel_z"] + 30, align=LEFT_LOW)
    )
    body -= Pos(0, 0, -30) * Cylinder(d["pin"] + d["clearance"], d["lintel_z"] + 60, align=LOW)
    body -= Pos(100, 0, d["lintel_z"] - 1) * Box(2 * d["leaf"], d["track"], 18, align=LEFT_LOW)

    return body, {
        "pivot": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "track": {"o": (0, 0, d["lintel_z"] + 1), "z": (1, 0, 0), "x": (0, 1, 0)},
    }
