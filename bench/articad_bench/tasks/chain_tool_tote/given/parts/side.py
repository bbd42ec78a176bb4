from build123d import Align, Box, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length, height, thickness = d["length"], d["height"], d["thickness"]
    shape = Pos(0, thickness / 2, 0) * Box(length, thickness, height, align=LOW)
    return shape, {"bottom": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
