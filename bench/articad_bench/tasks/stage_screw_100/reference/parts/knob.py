from build123d import Align, Cylinder

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    diameter, height, hole = d["diameter"], d["height"], d["hole"]
    shape = Cylinder(diameter / 2, height, align=LOW) - Cylinder(hole / 2, 4 * height)
    return shape, {"screw": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (0, 1, 0)}}
