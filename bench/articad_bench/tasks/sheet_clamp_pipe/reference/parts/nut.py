from build123d import Align, Cylinder, RegularPolygon, extrude

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    flange_diameter, flange_thickness, flats, height, bore_diameter = d["flange_diameter"], d["flange_thickness"], d["flats"], d["height"], d["bore_diameter"]
    shape = Cylinder(flange_diameter / 2, flange_thickness, align=LOW) + extrude(RegularPolygon(flats / 2, 6, major_radius=False), height)
    shape -= Cylinder(bore_diameter / 2, 4 * height)
    return shape, {
        "thread": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
