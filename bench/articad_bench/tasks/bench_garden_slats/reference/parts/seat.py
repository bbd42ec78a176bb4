from build123d import Box, Pos


def build(part):
    d = part.dimensions
    length, width, thickness, overhang = d["length"], d["width"], d["thickness"], d["overhang"]
    shape = Pos(length / 2, 0, thickness / 2) * Box(length, width, thickness)
    return shape, {
        "side": {"o": (overhang, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "other": {"o": (length - overhang, 0, 0), "z": (0, 0, 1), "x": (-1, 0, 0)},
    }
