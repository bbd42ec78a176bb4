from build123d import Circle, Cylinder, Plane, Pos, Rot, SlotCenterToCenter, extrude


def build(part):
    d = part.dimensions
    length, thick, inside = d["length"], d["thickness"], d["bar_y"]
    outline = Pos(length / 2, 0) * SlotCenterToCenter(length, d["width"])
    for x in (0, length / 2, length):
        outline -= Pos(x, 0) * Circle(d["bore_radius"])
    bars = extrude(Plane.XZ.offset(inside) * outline, thick) + extrude(Plane.XZ.offset(-inside - thick) * outline, thick)
    for x in (0.2 * length, 0.8 * length):
        bars += Pos(x, 0, 0) * Rot(X=90) * Cylinder(d["tube_radius"], 2 * inside + thick)
    axis = {"z": (0, -1, 0), "x": (1, 0, 0)}
    return bars, {"lower": {"o": (0, 0, 0), **axis}, "middle": {"o": (length / 2, 0, 0), **axis}, "upper": {"o": (length, 0, 0), **axis}}
