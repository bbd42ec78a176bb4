from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    shape = Pos(-1 * d["depth"] / 2, 0, -d["foot"]) * Box(d["depth"], d["wide"], d["foot"] + d["height"], align=LOW)
    shape -= Pos(0, 0, -d["foot"] - 1) * Box(3 * d["depth"], d["groove"], d["groove_h"] + 1, align=LOW) + Rot(Y=90) * Cylinder(d["bore"], 1000)
    return shape, {
        "groove": {"o": (0, 0, -d["foot"] - 0.3), "z": (1, 0, 0), "x": (0, 0, 1)},
    }
