from build123d import Align, Cylinder

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    outside_diameter, flange_diameter, flange_thickness, bore_diameter, length = d["outside_diameter"], d["flange_diameter"], d["flange_thickness"], d["bore_diameter"], d["length"]
    shape = Cylinder(outside_diameter / 2, length, align=LOW) + Cylinder(flange_diameter / 2, flange_thickness, align=LOW)
    shape -= Cylinder(bore_diameter / 2, 4 * length)
    return shape, {
        "bore": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
