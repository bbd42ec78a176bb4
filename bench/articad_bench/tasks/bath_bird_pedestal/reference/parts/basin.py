from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    diameter, height, wall = d["diameter"], d["height"], d["wall"]
    shape = Cylinder(diameter / 2, height, align=LOW) - Pos(0, 0, wall) * Cylinder(diameter / 2 - wall, height, align=LOW)
    return shape, {"pedestal": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
