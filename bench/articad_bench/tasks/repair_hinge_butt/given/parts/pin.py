from build123d import Align, Cylinder

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    diameter, length, head_radius, head_height = d["diameter"], d["length"], d["head_radius"], d["head_height"]
    shape = Cylinder(diameter / 2, length, align=HIGH) + Cylinder(head_radius, head_height, align=LOW)

    return shape, {"head": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
