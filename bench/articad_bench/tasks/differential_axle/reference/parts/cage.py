from build123d import Box, Cylinder, Pos, Rot


def build(part):
    d = part.dimensions
    shape = Cylinder(d["pin_r"], 2 * (d["cage_r"] - d["bar"] / 2))
    for s in (-1, 1):
        shape += Pos(s * d["cheek"], 0, 0) * Rot(Y=90) * Cylinder(d["cage_r"], d["thick"]) + Pos(s * (d["cheek"] + d["reach"]) / 2, 0, 0) * Rot(Y=90) * Cylinder(d["trunnion_r"], d["reach"] - d["cheek"])
        shape += Pos(0, 0, s * (d["cage_r"] - d["bar"] / 2)) * Box(2 * d["cheek"], 2 * d["bar"], d["bar"])
    for s in (-1, 1):
        shape -= Pos(s * (d["cheek"] + d["reach"]) / 2, 0, 0) * Rot(Y=90) * Cylinder(d["bore"], d["reach"])
    return shape, {
        "axle": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 0, 1)},
        "inner": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 0, 1)},
        "spider": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
