from build123d import Box, Pos


def build(part):
    d = part.dimensions
    length, height, start, depth, wall = d["length"], d["height"], d["start"], d["depth"], d["wall"]
    lip = d["lip"]
    shape = Pos(length / 2, start + depth / 2, 0) * Box(length, depth, height)
    shape -= Pos(length / 2, start + depth / 2, 0) * Box(2 * length, depth - 2 * wall, height - 2 * wall)
    shape -= Pos(length / 2, start + depth, 0) * Box(2 * length, 3 * wall, height - 2 * wall - 2 * lip)
    return shape, {"outer": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}, "inner": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}}
