from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    outside_diameter, inside_diameter, width, tapped_diameter = d["outside_diameter"], d["inside_diameter"], d["width"], d["tapped_diameter"]
    shape = Rot(X=-90) * (Cylinder(outside_diameter / 2, width, align=LOW) - Cylinder(inside_diameter / 2, 3 * width))
    shape -= Pos(0, width / 2, 0) * Cylinder(tapped_diameter / 2, outside_diameter, align=LOW)
    return shape, {
        "face": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)},
    }
