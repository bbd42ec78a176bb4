from build123d import Cylinder, Rot


def build(part):
    d = part.dimensions
    shape = Rot(Y=90) * Cylinder(d["radius"], d["length"])
    return shape, {"axis": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}}
