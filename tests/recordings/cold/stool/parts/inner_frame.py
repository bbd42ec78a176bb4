from build123d import Cylinder, Line, Plane, Pos, Rot, ThreePointArc, extrude, make_face


def along_y(radius, y0, y1, x, z):
    return Pos(x, (y0 + y1) / 2, z) * Rot(X=90) * Cylinder(radius, abs(y1 - y0))


def build(part):
    d = part.dimensions
    w, top = d["half_width"], d["top_z"]
    inner, outer = d["leg_inner_y"], d["leg_outer_y"]
    thick = outer - inner
    mid = (inner + outer) / 2
    a, b = (-w, -d["foot_short"]), (w, -d["foot_long"])
    c, e = (w, top), (-w, top)
    face = make_face([Line(a, b), Line(b, c), ThreePointArc(c, (0, top + w), e), Line(e, a)])
    leg = extrude(Plane.XZ * face, amount=thick)  # y from 0 to -thick
    shape = Pos(0, outer, 0) * leg
    shape += along_y(d["rod_radius"], -mid, mid, 0, top)
    shape += Pos(0, -inner, 0) * leg
    shape += along_y(d["stretcher_radius"], -mid, mid, 0, -d["stretcher_drop"])
    for s in (1, -1):
        shape += along_y(d["pin_radius"], s * mid, s * d["pin_end_y"], 0, -d["pin_drop"])
    reach = outer + thick
    shape -= along_y(d["pivot_bore_radius"], -reach, reach, 0, 0)
    y, z = d["brace_mid_y"], -d["pin_drop"]
    return shape, {
        "pivot": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)},
        "top_rod": {"o": (0, 0, top), "z": (0, 1, 0), "x": (0, 0, 1)},
        "brace_pin_front": {"o": (0, -y, z), "z": (0, -1, 0), "x": (0, 0, -1)},
        "brace_pin_back": {"o": (0, y, z), "z": (0, -1, 0), "x": (0, 0, -1)},
    }
