from build123d import Align, Cylinder

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    diameter, thickness, hole = d["diameter"], d["thickness"], d["hole"]
    shape = Cylinder(diameter / 2, thickness, align=LOW) - Cylinder(hole / 2, 4 * thickness)
    return shape, {
        "below": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "above": {"o": (0, 0, thickness), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
