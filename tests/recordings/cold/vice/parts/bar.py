from build123d import Cylinder, Rot


def build(part):
    d = part.dimensions
    length = d["length"]
    shape = Rot(Y=90) * Cylinder(d["radius"], length)
    return shape, {
        "slide": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)},
        "end_right": {"o": (length / 2, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)},
        "end_left": {"o": (-length / 2, 0, 0), "z": (-1, 0, 0), "x": (0, 1, 0)},
    }
