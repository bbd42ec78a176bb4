from build123d import Align, Cylinder

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    diameter, length = d["diameter"], d["length"]
    shape = Cylinder(diameter / 2, length, align=LOW)
    return shape, {"end": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (0, 1, 0)}}
