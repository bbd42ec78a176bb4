from build123d import Box, Pos


def build(part):
    d = part.dimensions
    length, depth, thickness = d["length"], d["depth"], d["thickness"]
    shape = Pos(length / 2, 0, 0) * Box(length, depth, thickness)

    return shape, {
        "left": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "right": {"o": (length, 0, 0), "z": (0, 0, 1), "x": (-1, 0, 0)},
    }
