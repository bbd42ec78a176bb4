from build123d import Align, Box

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length, width, height = d["length"], d["width"], d["height"]
    shape = Box(width, length, height, align=LOW)
    return shape, {
        "deck_1": {"o": (0, -165.0, height), "z": (0, 0, 1), "x": (1, 0, 0)},
        "deck_2": {"o": (0, -82.5, height), "z": (0, 0, 1), "x": (1, 0, 0)},
        "deck_3": {"o": (0, 0.0, height), "z": (0, 0, 1), "x": (1, 0, 0)},
        "deck_4": {"o": (0, 82.5, height), "z": (0, 0, 1), "x": (1, 0, 0)},
        "deck_5": {"o": (0, 165.0, height), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
