from build123d import Box, Cylinder, Pos


def build(part):
    d = part.dimensions
    shape = Cylinder(d["disc_r"], d["thickness"])
    shape -= Pos(0, 0, d["thickness"] / 2) * Box(4 * d["disc_r"], d["slot"], 2 * d["deep"]) + Pos(0, 0, -d["thickness"] / 2) * Box(d["slot"], 4 * d["disc_r"], 2 * d["deep"])
    return shape, {
        "upper": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 0, 1)},
        "lower": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)},
    }
