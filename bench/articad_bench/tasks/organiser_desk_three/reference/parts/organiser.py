from build123d import Align, Box, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    width, depth, height, wall, front = d["width"], d["depth"], d["height"], d["wall"], d["front"]
    shape = Box(width, depth, height, align=LOW)
    cell = (width - 4 * wall) / 3
    shape -= [Pos((cell + wall) * i, 0, wall) * Box(cell, depth - 2 * wall, height, align=LOW) for i in (-1, 0, 1)]
    shape -= Pos(0, -depth / 2, front) * Box(2 * width, 4 * wall, height, align=LOW)
    return shape, {}
