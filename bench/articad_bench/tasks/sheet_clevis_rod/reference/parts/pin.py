from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    diameter, length, head_diameter, head_height, groove_diameter, groove_start = d["diameter"], d["length"], d["head_diameter"], d["head_height"], d["groove_diameter"], d["groove_start"]
    groove_width, grease_hole_diameter, grease_hole_depth = d["groove_width"], d["grease_hole_diameter"], d["grease_hole_depth"]
    shape = Cylinder(diameter / 2, length, align=HIGH) + Cylinder(head_diameter / 2, head_height, align=LOW)
    shape -= Pos(0, 0, -groove_start) * (Cylinder(diameter, groove_width, align=HIGH) - Cylinder(groove_diameter / 2, groove_width, align=HIGH))
    shape -= Pos(0, 0, head_height) * Cylinder(grease_hole_diameter / 2, grease_hole_depth, align=HIGH)
    return shape, {
        "head": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "groove": {"o": (0, 0, -groove_start), "z": (0, 0, -1), "x": (1, 0, 0)},
    }
