from build123d import Box, Pos


def build(part):
    d = part.dimensions
    width, height, thickness = d["width"], d["height"], d["thickness"]
    shape = Pos(width / 2, thickness / 2, 0) * Box(width, thickness, height)

    return shape, {"left": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)}}
