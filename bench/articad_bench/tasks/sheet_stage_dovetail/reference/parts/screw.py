from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    diameter, length, neck_diameter, neck, head_diameter, head_height = d["diameter"], d["length"], d["neck_diameter"], d["neck"], d["head_diameter"], d["head_height"]
    shape = Cylinder(diameter / 2, length, align=HIGH) + Cylinder(neck_diameter / 2, neck, align=LOW)
    shape += Pos(0, 0, neck) * Cylinder(head_diameter / 2, head_height, align=LOW)
    return shape, {
        "thread": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
