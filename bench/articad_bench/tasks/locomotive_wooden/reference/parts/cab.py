from build123d import Align, Box, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length, width, height, window = d["length"], d["width"], d["height"], d["window"]
    shape = Box(length, width, height, align=LOW) - Pos(0, 0, 0.65 * height) * Box(window, 2 * width, window)
    return shape, {"chassis": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
