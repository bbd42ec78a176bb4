from build123d import Align, Cylinder

HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    diameter, height, bore_diameter = d["diameter"], d["height"], d["bore_diameter"]
    shape = Cylinder(diameter / 2, height, align=HIGH) - Cylinder(bore_diameter / 2, 4 * height)
    return shape, {
        "seat": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "thread": {"o": (0, 0, -height), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
