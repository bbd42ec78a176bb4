from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    outside_diameter, inside_diameter, length, tapped_diameter = d["outside_diameter"], d["inside_diameter"], d["length"], d["tapped_diameter"]
    shape = Cylinder(outside_diameter / 2, length, align=LOW) - Cylinder(inside_diameter / 2, 4 * length)
    shape -= Pos(0, 0, length / 3) * Rot(Y=90) * Cylinder(tapped_diameter / 2, outside_diameter, align=LOW)
    return shape, {
        "seat": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
