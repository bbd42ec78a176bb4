from build123d import Align, Box, Pos

HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    width, depth, height, radius = d["width"], d["depth"], d["height"], d["radius"]
    shape = Pos(radius, 0, 0) * Box(width, depth, height, align=HIGH)
    return shape, {"arch": {"o": (radius, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
