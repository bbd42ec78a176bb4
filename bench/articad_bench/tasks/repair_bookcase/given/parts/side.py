from build123d import Align, Box

CORNER = (Align.MIN, Align.MIN, Align.MIN)


def build(part):
    d = part.dimensions
    depth, height, thickness = d["depth"], d["height"], d["thickness"]
    shape = Box(thickness, depth, height, align=CORNER)

    return shape, {
        "bottom": {"o": (thickness, depth/2, 69), "z": (0, 0, 1), "x": (1, 0, 0)},
        "shelf": {"o": (thickness, depth/2, 470), "z": (0, 0, 1), "x": (1, 0, 0)},
        "top": {"o": (thickness, depth/2, height - thickness/2), "z": (0, 0, 1), "x": (1, 0, 0)},
        "back": {"o": (0, depth, height/2), "z": (0, 1, 0), "x": (1, 0, 0)},
    }
