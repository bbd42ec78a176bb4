from build123d import Align, Cylinder

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    outside_diameter, bore_diameter, thickness = d["outside_diameter"], d["bore_diameter"], d["thickness"]
    shape = Cylinder(outside_diameter / 2, thickness, align=LOW) - Cylinder(bore_diameter / 2, 4 * thickness)
    return shape, {
        "seat": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
