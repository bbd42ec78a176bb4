from build123d import Align, Box, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length, width, thickness, seat = d["length"], d["width"], d["thickness"], d["seat"]
    shape = Pos(length / 2 - seat, 0, 0) * Box(length, width, thickness, align=LOW)
    return shape, {
        "end": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "middle": {"o": (length/2 - seat, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "far": {"o": (length - 2*seat, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
