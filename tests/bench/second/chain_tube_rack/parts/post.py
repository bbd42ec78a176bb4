from build123d import Align, Cylinder

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    diameter, length = d["diameter"], d["length"]
    shape = Cylinder(diameter / 2, length, align=LOW)
    return shape, {"foot": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}, "top": {"o": (0, 0, length), "z": (0, 0, 1), "x": (1, 0, 0)}}
