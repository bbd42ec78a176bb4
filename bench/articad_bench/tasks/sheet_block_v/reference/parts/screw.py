from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    diameter, length, pin_diameter, pin_length, neck, head_diameter = d["diameter"], d["length"], d["pin_diameter"], d["pin_length"], d["neck"], d["head_diameter"]
    head_height, cross_hole_diameter = d["head_height"], d["cross_hole_diameter"]
    shape = Cylinder(diameter / 2, length, align=HIGH) + Cylinder(diameter / 2, neck, align=LOW)
    shape += Pos(0, 0, -length) * Cylinder(pin_diameter / 2, pin_length, align=HIGH)
    shape += Pos(0, 0, neck) * Cylinder(head_diameter / 2, head_height, align=LOW)
    shape -= Pos(0, 0, neck + head_height / 2) * Rot(Y=90) * Cylinder(cross_hole_diameter / 2, 2 * head_diameter)
    return shape, {
        "thread": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
