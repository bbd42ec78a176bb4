from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    shape = Pos(d["end_u"] / 2, d["end_v"] / 2, -d["low"] - d["board"]) * Box(d["end_u"] + 2 * d["near"] + 2 * d["wide"], d["end_v"] + 2 * d["depth"], d["board"], align=LOW)
    for u, v in ((-d["near"], 0), (d["end_u"] + d["near"], d["end_v"])):
        shape += Pos(u, v, -d["low"] - 1) * Box(d["wide"], d["depth"], d["low"] + 1 + d["wide"], align=LOW) - Pos(u, v, 0) * Rot(Y=90) * Cylinder(d["bore"], 100)
    return shape, {
        "input": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 0, 1)},
        "output": {"o": (d["end_u"], d["end_v"], 0), "z": (1, 0, 0), "x": (0, 0, 1)},
    }
