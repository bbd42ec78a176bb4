from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    diameter, length, head_diameter, head_height, cross_hole_diameter, cross_hole_from_end = d["diameter"], d["length"], d["head_diameter"], d["head_height"], d["cross_hole_diameter"], d["cross_hole_from_end"]
    shape = Cylinder(diameter / 2, length, align=HIGH) + Cylinder(head_diameter / 2, head_height, align=LOW)
    shape -= Pos(0, 0, cross_hole_from_end - length) * Rot(Y=90) * Cylinder(cross_hole_diameter / 2, 2 * diameter)
    return shape, {
        "head": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
