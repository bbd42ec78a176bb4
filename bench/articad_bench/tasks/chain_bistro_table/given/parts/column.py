from build123d import Align, Cylinder

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    diameter, length, wall = d["diameter"], d["length"], d["wall"]
    shape = Cylinder(diameter / 2, length, align=LOW) - Cylinder(diameter / 2 - wall, 3 * length)
    return shape, {"foot": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}, "plate": {"o": (0, 0, length), "z": (0, 0, 1), "x": (1, 0, 0)}}
