from build123d import Box, Cylinder, Pos, Rot


def build(part):
    d = part.dimensions
    shape = Pos(1 * (d["root"] + d["prong"] / 2), 0, 0) * Box(d["prong"], 2 * (d["core"] + d["prong"]), 2 * d["half"]) + Pos(d["length"] / 2, 0, 0) * Rot(Y=90) * Cylinder(d["shaft_r"], d["length"] - 2 * d["root"]) + Pos(d["length"], 0, 0) * (Pos(-1 * (d["root"] + d["prong"] / 2), 0, 0) * Box(d["prong"], 2 * (d["core"] + d["prong"]), 2 * d["half"]))
    for s in (-1, 1):
        shape += Pos(1 * d["root"] / 2, s * (d["core"] + d["prong"] / 2), 0) * Box(d["root"], d["prong"], 2 * d["half"]) + Pos(0, s * (d["core"] + d["prong"] / 2), 0) * Rot(X=90) * Cylinder(d["half"], d["prong"]) + Pos(d["length"], 0, 0) * (Pos(-1 * d["root"] / 2, s * (d["core"] + d["prong"] / 2), 0) * Box(d["root"], d["prong"], 2 * d["half"]) + Pos(0, s * (d["core"] + d["prong"] / 2), 0) * Rot(X=90) * Cylinder(d["half"], d["prong"]))
    shape -= Rot(X=90) * Cylinder(d["bore"], 100) + Pos(d["length"], 0, 0) * Rot(X=90) * Cylinder(d["bore"], 100)
    return shape, {
        "near": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)},
        "far": {"o": (d["length"], 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)},
    }
