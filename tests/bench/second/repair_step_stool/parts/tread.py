from build123d import Align, Box, Pos

HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    length, width, thickness = d["length"], d["width"], d["thickness"]
    shape = Pos(length / 2, 0, 0) * Box(length, width, thickness, align=HIGH)
    return shape, {
        "side": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "other": {"o": (length, 0, 0), "z": (0, 0, 1), "x": (-1, 0, 0)},
    }
