from build123d import Align, Box

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    width, height, length = d["width"], d["height"], d["length"]
    shape = Box(width, height, length, align=LOW)
    return shape, {"post": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}, "plate": {"o": (0, 0, length), "z": (0, 0, 1), "x": (1, 0, 0)}}
