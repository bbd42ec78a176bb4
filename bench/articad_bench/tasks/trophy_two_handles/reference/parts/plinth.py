from build123d import Align, Cylinder

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    diameter, height = d["diameter"], d["height"]
    shape = Cylinder(diameter / 2, height, align=LOW)
    return shape, {"block": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}, "stem": {"o": (0, 0, height), "z": (0, 0, 1), "x": (1, 0, 0)}}
