from build123d import Align, Box, Cylinder, Pos, Rot, Sphere

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    diameter, low, neck, neck_length, ball = d["diameter"], d["low"], d["neck"], d["neck_length"], d["ball"]
    head, head_low, head_high, bar_hole, bar_z = d["head"], d["head_low"], d["head_high"], d["bar_hole"], d["bar_z"]
    shape = Pos(0, 0, neck_length - low) * Cylinder(diameter / 2, low - neck_length + head_high - 4, align=LOW)
    shape += Pos(0, 0, -low) * Sphere(ball / 2) + Pos(0, 0, -low) * Cylinder(neck / 2, neck_length + 1, align=LOW)
    shape += Pos(0, 0, head_low) * Cylinder(head / 2, head_high - head_low, align=LOW)
    hole = Cylinder(bar_hole / 2, 2 * head)
    hole -= Pos(d["bar_flat"], 0, 0) * Box(bar_hole, bar_hole, 2 * head, align=(Align.MIN, Align.CENTER, Align.CENTER))
    shape -= Pos(0, 0, bar_z) * Rot(X=90) * hole
    return shape, {
        "thread": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "ball": {"o": (0, 0, -low), "z": (0, 0, -1), "x": (1, 0, 0)},
        "bar": {"o": (0, 0, bar_z), "z": (0, 1, 0), "x": (1, 0, 0)},
    }
