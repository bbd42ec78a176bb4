from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    diameter, height, hole, depth = d["diameter"], d["height"], d["hole"], d["depth"]
    shape = Cylinder(diameter / 2, height, align=LOW) - Pos(0, 0, height - depth) * Cylinder(hole / 2, height, align=LOW)
    return shape, {"stem": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
