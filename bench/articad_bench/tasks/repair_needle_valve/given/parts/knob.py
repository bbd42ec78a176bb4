from build123d import Align, Cylinder

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    diameter, height, hole, depth = d["diameter"], d["height"], d["hole"], d["depth"]
    shape = Cylinder(diameter / 2, height, align=LOW) - Cylinder(hole / 2, depth, align=LOW)
    return shape, {"needle": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
