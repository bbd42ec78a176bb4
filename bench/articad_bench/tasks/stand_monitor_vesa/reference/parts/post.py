from build123d import Align, Box

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    side, wall, height, arm_z = d["side"], d["wall"], d["height"], d["arm_z"]
    shape = Box(side, side, height, align=LOW) - Box(side - 2 * wall, side - 2 * wall, 4 * height)
    return shape, {
        "foot": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "arm": {"o": (0, -side/2, arm_z), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
