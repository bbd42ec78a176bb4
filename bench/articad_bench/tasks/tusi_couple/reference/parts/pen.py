from build123d import Align, Cylinder

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    shape = Cylinder(d["radius"], d["thickness"], align=LOW) - Cylinder(d["bore"], 100)
    return shape, {
        "bore": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
