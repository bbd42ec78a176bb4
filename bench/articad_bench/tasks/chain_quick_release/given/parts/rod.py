from build123d import Cylinder, Pos, Rot


def build(part):
    d = part.dimensions
    diameter, length, span = d["diameter"], d["length"], d["span"]
    shape = Pos(-length / 2, 0, 0) * Rot(Y=90) * Cylinder(diameter / 2, length)
    return shape, {"cap": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}, "nut": {"o": (-span, 0, 0), "z": (-1, 0, 0), "x": (0, 1, 0)}}
