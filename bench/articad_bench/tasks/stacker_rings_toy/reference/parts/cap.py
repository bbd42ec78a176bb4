from build123d import Align, Cylinder, Pos, Sphere

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    diameter, hole, depth = d["diameter"], d["hole"], d["depth"]
    shape = Pos(0, 0, diameter / 2 - depth) * Sphere(diameter / 2) - Pos(0, 0, -depth) * Cylinder(hole / 2, depth, align=LOW)
    return shape, {"peg": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
