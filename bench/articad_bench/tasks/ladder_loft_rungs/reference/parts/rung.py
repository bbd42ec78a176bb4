from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    diameter, inside, rail = d["diameter"], d["inside"], d["rail"]
    shape = Pos(0, 0, -rail) * Cylinder(diameter / 2, inside + 2 * rail, align=LOW)
    return shape, {
        "left": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (0, 1, 0)},
        "right": {"o": (0, 0, inside), "z": (0, 0, -1), "x": (0, 1, 0)},
    }
