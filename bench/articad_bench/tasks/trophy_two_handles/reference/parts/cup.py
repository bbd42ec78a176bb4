from build123d import Align, Cone, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    foot, rim, height, wall, floor = d["foot"], d["rim"], d["height"], d["wall"], d["floor"]
    shape = Cone(foot / 2, rim / 2, height, align=LOW)
    low = foot / 2 + (rim - foot) / 2 * floor / height - wall
    shape -= Pos(0, 0, floor) * Cone(low, rim / 2 - wall, height - floor, align=LOW)
    return shape, {
        "stem": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "right": {"o": (foot/4 + rim/4, 0, height/2), "z": (0, 0, 1), "x": (1, 0, 0)},
        "left": {"o": (-foot/4 - rim/4, 0, height/2), "z": (0, 0, 1), "x": (-1, 0, 0)},
    }
