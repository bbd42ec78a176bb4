from build123d import Align, Box

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    side, height = d["side"], d["height"]
    shape = Box(side, side, height, align=LOW)
    return shape, {"plinth": {"o": (0, 0, height), "z": (0, 0, 1), "x": (1, 0, 0)}}
