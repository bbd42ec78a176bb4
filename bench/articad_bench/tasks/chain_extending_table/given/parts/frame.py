from build123d import Align, Box, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(0, 0, d["leg_height"] - d["apron"]) * (Box(1000, 650, d["apron"], align=LOW) - Box(952, 602, 3 * d["apron"], align=LOW))
    for side in (-1, 1):
        body += Pos(0, side * 313, d["leg_height"] - 1) * Box(960, d["rail"], 13, align=LOW)

    return body, {
        "right": {"o": (0, 0, d["leg_height"]), "z": (1, 0, 0), "x": (0, 1, 0)},
        "left": {"o": (0, 0, d["leg_height"]), "z": (-1, 0, 0), "x": (0, -1, 0)},
        "leg_0": {"o": (443.5, 268.5, d["leg_height"]), "z": (0, 0, 1), "x": (1, 0, 0)},
        "leg_1": {"o": (-443.5, 268.5, d["leg_height"]), "z": (0, 0, 1), "x": (1, 0, 0)},
        "leg_2": {"o": (443.5, -268.5, d["leg_height"]), "z": (0, 0, 1), "x": (1, 0, 0)},
        "leg_3": {"o": (-443.5, -268.5, d["leg_height"]), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
