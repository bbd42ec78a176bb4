from build123d import Align, Box

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    side, wall, height = d["side"], d["wall"], d["height"]
    shape = Box(side, side, height, align=LOW) - Box(side - 2 * wall, side - 2 * wall, 3 * height)
    return shape, {
        "plate": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "gusset_1": {"o": (side / 2, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "gusset_2": {"o": (0, side / 2, 0), "z": (0, 0, 1), "x": (0, 1, 0)},
        "gusset_3": {"o": (-side / 2, 0, 0), "z": (0, 0, 1), "x": (-1, 0, 0)},
        "gusset_4": {"o": (0, -side / 2, 0), "z": (0, 0, 1), "x": (0, -1, 0)},
    }
