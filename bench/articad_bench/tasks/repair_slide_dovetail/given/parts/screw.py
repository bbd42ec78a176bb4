from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    diameter, shank, gap, head, head_height = d["diameter"], d["shank"], d["gap"], d["head"], d["head_height"]
    shape = Cylinder(diameter / 2, shank, align=HIGH) + Cylinder(diameter / 2, gap, align=LOW) + Pos(0, 0, gap) * Cylinder(head / 2, head_height, align=LOW)
    return shape, {"saddle": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
