from build123d import Align, Box

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    width, depth, thickness, back = d["width"], d["depth"], d["thickness"], d["back"]
    shape = Box(width, depth, thickness, align=LOW)
    return shape, {"post": {"o": (0, back, thickness), "z": (0, 0, 1), "x": (1, 0, 0)}}
