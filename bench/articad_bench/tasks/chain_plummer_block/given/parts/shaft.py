from build123d import Cylinder


def build(part):
    d = part.dimensions
    diameter, length = d["diameter"], d["length"]
    shape = Cylinder(diameter / 2, length)
    return shape, {"bearing": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
