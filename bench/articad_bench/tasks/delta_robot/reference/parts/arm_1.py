from build123d import Box, Cylinder, Pos, Rot


def build(part):
    d = part.dimensions
    shape = Pos((d["length"] - d["root"]) / 2, 0, 0) * Box(d["length"] - d["root"], 2 * d["half"], 2 * d["half"]) + Rot(X=90) * Cylinder(d["eye"], d["wide"])
    shape += Pos(d["length"] - d["root"] - d["prong"] / 2, 0, 0) * Box(d["prong"], 2 * (d["core"] + d["prong"]), 2 * d["half"])
    for s in (-1, 1):
        shape += Pos(d["length"] - d["root"] / 2, s * (d["core"] + d["prong"] / 2), 0) * Box(d["root"], d["prong"], 2 * d["half"]) + Pos(d["length"], s * (d["core"] + d["prong"] / 2), 0) * Rot(X=90) * Cylinder(d["half"], d["prong"])
    shape -= Rot(X=90) * Cylinder(d["bore"], 1000) + Pos(d["length"], 0, 0) * Rot(X=90) * Cylinder(d["bore"], 1000)
    return shape, {
        "shaft": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)},
        "knee": {"o": (d["length"], 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)},
    }
