from build123d import Align, Cylinder, Plane, Pos, Rot, SlotCenterToCenter, extrude

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length, thick, inside = d["length"], d["thickness"], d["bar_y"]
    outline = Pos(length / 2, 0) * SlotCenterToCenter(length, d["width"])
    bars = extrude(Plane.XZ.offset(inside) * outline, thick) + extrude(Plane.XZ.offset(-inside - thick) * outline, thick)
    for x in (0.2 * length, 0.8 * length):
        bars += Pos(x, 0, 0) * Rot(X=90) * Cylinder(d["tube_radius"], 2 * inside + thick)
    for x in (0, length / 2, length):
        for side in (-1, 1):
            inner_end = side * (inside - d["pin_length"])
            bars += Pos(x, inner_end, 0) * Rot(X=-90 * side) * Cylinder(d["pin_radius"], d["pin_length"], align=LOW)
    axis = {"z": (0, -1, 0), "x": (1, 0, 0)}
    return bars, {"lower": {"o": (0, 0, 0), **axis}, "middle": {"o": (length / 2, 0, 0), **axis}, "upper": {"o": (length, 0, 0), **axis}}
