from build123d import Align, Box, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    depth, height, step, thickness = d["depth"], d["height"], d["step"], d["thickness"]
    shape = Pos(-thickness / 2, depth / 2, 0) * Box(thickness, depth, height, align=LOW)
    shape -= Pos(0, 0, step) * Box(4 * thickness, depth, height, align=LOW)
    return shape, {
        "lower": {"o": (0, depth/4, step), "z": (0, 0, 1), "x": (1, 0, 0)},
        "upper": {"o": (0, 0.75*depth, height), "z": (0, 0, 1), "x": (1, 0, 0)},
        "brace": {"o": (0, depth, height), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
