from build123d import Box, Pos


def build(part):
    d = part.dimensions
    length, height, start, depth, tongue = d["length"], d["height"], d["start"], d["depth"], d["tongue"]
    tongue_end = d["tongue_end"]
    shape = Pos(length / 2, start + depth / 2, 0) * Box(length, depth, height)
    shape += Pos(length / 2, (start + tongue_end) / 2, 0) * Box(length, tongue_end - start, tongue)
    return shape, {"middle": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}}
