from build123d import Align, Box, Pos


def build(part):
    d = part.dimensions
    length, depth, thickness, tube = d["length"], d["depth"], d["thickness"], d["tube"]
    shape = Pos(0, -depth + 4, 0.3) * Box(length, depth - 4, thickness, align=(Align.CENTER, Align.MIN, Align.MIN))
    return shape, {
        "hinge": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)},
    }
