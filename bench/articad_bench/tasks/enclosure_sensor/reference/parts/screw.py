from build123d import Align, Cylinder

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    shank, core, head, head_height, plain = d["shank"], d["core"], d["head"], d["head_height"], d["plain"]
    length = d["length"]
    shape = Cylinder(head / 2, head_height, align=LOW) + Cylinder(shank / 2, plain, align=HIGH) + Cylinder(core / 2, length, align=HIGH)
    return shape, {"head": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
