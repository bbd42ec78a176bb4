from build123d import Box, Cylinder, Rot


def build(part):
    d = part.dimensions
    shape = Box(2 * d["core"], 2 * d["core"], 2 * d["core"]) + Cylinder(d["pin_r"], 2 * d["reach"]) + Rot(X=90) * Cylinder(d["pin_r"], 2 * d["reach"])
    return shape, {
        "upright": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "level": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)},
    }
