from build123d import Align, Cylinder

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    outside, inside, length = d["outside"], d["inside"], d["length"]
    shape = Cylinder(outside / 2, length, align=LOW) - Cylinder(inside / 2, 4 * length)
    return shape, {
        "below": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "above": {"o": (0, 0, length), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
