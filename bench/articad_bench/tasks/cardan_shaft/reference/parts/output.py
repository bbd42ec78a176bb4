from build123d import Box, Cylinder, Pos, Rot


def build(part):
    d = part.dimensions
    shape = Pos(1 * (d["root"] + d["prong"] / 2), 0, 0) * Box(d["prong"], 2 * d["half"], 2 * (d["core"] + d["prong"])) + Pos(1 * (d["root"] + d["reach"]) / 2, 0, 0) * Rot(Y=90) * Cylinder(d["shaft_r"], d["reach"] - d["root"])
    for s in (-1, 1):
        shape += Pos(1 * d["root"] / 2, 0, s * (d["core"] + d["prong"] / 2)) * Box(d["root"], 2 * d["half"], d["prong"]) + Pos(0, 0, s * (d["core"] + d["prong"] / 2)) * Cylinder(d["half"], d["prong"])
    shape -= Cylinder(d["bore"], 100)
    return shape, {
        "shaft": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 0, 1)},
        "fork": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
