from build123d import Align, Cylinder

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    diameter, thickness, peg, peg_length = d["diameter"], d["thickness"], d["peg"], d["peg_length"]
    shape = Cylinder(diameter / 2, thickness, align=LOW) + Cylinder(peg / 2, thickness + peg_length, align=LOW)
    return shape, {
        "ring": {"o": (0, 0, thickness), "z": (0, 0, 1), "x": (1, 0, 0)},
        "cap": {"o": (0, 0, thickness + peg_length), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
