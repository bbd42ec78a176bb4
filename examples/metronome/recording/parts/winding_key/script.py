from build123d import Cylinder, Plane, Pos, RectangleRounded, Rot, extrude


def along_x(radius, x0, x1):
    return Pos((x0 + x1) / 2, 0, 0) * Rot(Y=90) * Cylinder(radius, x1 - x0)


def build(part):
    d = part.dimensions
    start, end = d["wing_start"], d["wing_end"]
    shoulder = start + d["wing_overlap"]
    shaft = along_x(d["shaft_radius"], -d["shaft_left"], shoulder)
    collar = along_x(d["collar_radius"], d["collar_start"], shoulder)
    outline = RectangleRounded(end - start, 2 * d["wing_half"], d["corner_radius"])
    wing = Pos((start + end) / 2, 0, 0) * extrude(Plane.XZ * outline, amount=d["wing_thickness"] / 2, both=True)
    shape = shaft + collar + wing
    return shape, {"axis": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 0, 1)}}
