from build123d import Align, Box

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    side, thickness = d["side"], d["thickness"]
    shape = Box(side, side, thickness, align=LOW)
    return shape, {
        "column": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "top": {"o": (0, 0, thickness), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
