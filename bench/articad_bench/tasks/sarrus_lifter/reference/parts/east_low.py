from build123d import Box, Cylinder, Pos, Rot


def build(part):
    d = part.dimensions
    shape = Pos(d["leaf"] / 2, 0, 0) * Box(d["leaf"], d["wide"], d["thick"]) + Rot(X=90) * Cylinder(d["eye"], d["wide"]) + Pos(d["leaf"], 0, 0) * Rot(X=90) * Cylinder(d["eye"], d["wide"] / 3)
    for s in (-1, 1):
        shape -= Pos(d["leaf"], s * d["wide"] / 2, 0) * Box(4 * d["eye"], 2 * d["wide"] / 3, 4 * d["eye"])
    shape -= Rot(X=90) * Cylinder(d["bore"], 1000) + Pos(d["leaf"], 0, 0) * Rot(X=90) * Cylinder(d["bore"], 1000)
    return shape, {
        "foot": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "knee": {"o": (d["leaf"], 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
