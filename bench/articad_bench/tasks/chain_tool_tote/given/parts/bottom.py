from build123d import Align, Box

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length, width, thickness = d["length"], d["width"], d["thickness"]
    shape = Box(length, width, thickness, align=LOW)
    return shape, {
        "front": {"o": (0, -width/2, thickness), "z": (0, 0, 1), "x": (1, 0, 0)},
        "back": {"o": (0, width/2, thickness), "z": (0, 0, 1), "x": (-1, 0, 0)},
        "left": {"o": (-length/2, 0, thickness), "z": (0, 0, 1), "x": (1, 0, 0)},
        "right": {"o": (length/2, 0, thickness), "z": (0, 0, 1), "x": (-1, 0, 0)},
    }
