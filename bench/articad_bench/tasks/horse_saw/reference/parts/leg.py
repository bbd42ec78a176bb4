from build123d import Align, Box, Pos

HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    width, thickness, length = d["width"], d["thickness"], d["length"]
    shape = Pos(0, thickness / 2, 0) * Box(width, thickness, length, align=HIGH)
    return shape, {
        "beam": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "stretcher": {"o": (0, 0, -length), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
