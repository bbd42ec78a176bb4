from build123d import Align, Cylinder, RegularPolygon, extrude

HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    diameter, length, flats, head = d["diameter"], d["length"], d["flats"], d["head"]
    shape = Cylinder(diameter / 2, length, align=HIGH) + extrude(RegularPolygon(flats / 2, 6, major_radius=False), head)
    return shape, {"seat": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
