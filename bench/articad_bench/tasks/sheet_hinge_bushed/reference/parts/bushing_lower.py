from build123d import Align, Cylinder

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    outside_diameter, bore_diameter, barrel, flange_diameter, flange_thickness = d["outside_diameter"], d["bore_diameter"], d["barrel"], d["flange_diameter"], d["flange_thickness"]
    shape = Cylinder(outside_diameter / 2, barrel, align=LOW) + Cylinder(flange_diameter / 2, flange_thickness, align=HIGH)
    shape -= Cylinder(bore_diameter / 2, 4 * barrel)
    return shape, {
        "seat": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "bore": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
