from build123d import Align, Cylinder

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    diameter, thickness = d["diameter"], d["thickness"]
    shape = Cylinder(diameter / 2, thickness, align=LOW)
    return shape, {"column": {"o": (0, 0, thickness), "z": (0, 0, 1), "x": (1, 0, 0)}}
