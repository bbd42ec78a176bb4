from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    diameter, length, head, head_height = d["diameter"], d["length"], d["head"], d["head_height"]
    shape = Cylinder(diameter / 2, length, align=LOW)
    shape += Cylinder(head / 2, head_height, align=HIGH) + Pos(0, 0, length) * Cylinder(head / 2, head_height, align=LOW)
    return shape, {"fork": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
