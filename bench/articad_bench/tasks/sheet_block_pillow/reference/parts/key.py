from build123d import Align, Box

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length, width, height = d["length"], d["width"], d["height"]
    shape = Box(width, length, height, align=LOW)
    return shape, {
        "bottom": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
