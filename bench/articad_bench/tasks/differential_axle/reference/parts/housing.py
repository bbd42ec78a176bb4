from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    shape = Pos(0, 0, -d["drop"]) * Box(d["length"], d["depth"], d["plate"], align=HIGH)
    for s in (-1, 1):
        shape += Pos(s * d["at"], 0, -d["drop"] - 1) * Box(d["wide"], 40, d["drop"] + 20, align=LOW)
    shape -= Rot(Y=90) * Cylinder(d["bore"], 1000)
    return shape, {
        "axle": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 0, 1)},
    }
