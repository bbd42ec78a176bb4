from build123d import Align, Cylinder, Plane, Polyline, Pos, extrude, make_face

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    r, length = d["radius"], d["length"]
    shape = Cylinder(r, length, align=UP) - Pos(0, 0, -1) * Cylinder(d["bore_radius"], length + 2, align=UP)
    ry, rh, oy, oh = d["root_y"], d["gap_root_half"], d["open_y"], d["gap_open_half"]
    section = make_face(Polyline((ry, -rh), (oy, -oh), (oy, oh), (ry, rh), close=True))
    gap = extrude(Plane.YZ * section, amount=r + 1, both=True)
    for k in range(d["gap_count"]):
        shape -= Pos(0, 0, d["gap_start"] + k * d["gap_pitch"]) * gap
    return shape, {
        "slide": {"o": (0, 0, 0), "z": (0, 0, -1), "x": (1, 0, 0)},
        "spindle": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
