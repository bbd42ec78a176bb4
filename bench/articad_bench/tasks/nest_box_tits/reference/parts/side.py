from build123d import Align, Box, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    depth, height, thickness = d["depth"], d["height"], d["thickness"]
    shape = Pos(-thickness / 2, 0, 0) * Box(thickness, depth, height, align=LOW)
    return shape, {"floor": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
