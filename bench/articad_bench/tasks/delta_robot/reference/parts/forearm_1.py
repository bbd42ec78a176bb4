from build123d import Box, Cylinder, Pos, Rot


def build(part):
    d = part.dimensions
    shape = Pos(d["length"] / 2, 0, 0) * Rot(Y=90) * Cylinder(d["rod_r"], d["length"] - 2 * d["root"])
    for u, side in ((0, 1), (d["length"], -1)):
        shape += Pos(u + side * (d["root"] + d["prong"] / 2), 0, 0) * Box(d["prong"], 2 * d["half"], 2 * (d["core"] + d["prong"]))
        for s in (-1, 1):
            shape += Pos(u + side * d["root"] / 2, 0, s * (d["core"] + d["prong"] / 2)) * Box(d["root"], 2 * d["half"], d["prong"]) + Pos(u, 0, s * (d["core"] + d["prong"] / 2)) * Cylinder(d["half"], d["prong"])
    shape -= Cylinder(d["bore"], 1000) + Pos(d["length"], 0, 0) * Cylinder(d["bore"], 1000)
    return shape, {
        "near": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "far": {"o": (d["length"], 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
