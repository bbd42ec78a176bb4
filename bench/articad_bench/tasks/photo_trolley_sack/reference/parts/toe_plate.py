from build123d import Align, Box


def build(part):
    d = part.dimensions
    width, depth, thickness = d["width"], d["depth"], d["thickness"]
    shape = Box(width, depth, thickness, align=(Align.CENTER, Align.MAX, Align.MAX)) + Box(width, 30, thickness, align=(Align.CENTER, Align.MIN, Align.MAX))
    return shape, {
        "rails": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
