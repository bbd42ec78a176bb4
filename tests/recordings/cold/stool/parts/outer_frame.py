from build123d import Box, Cylinder, Line, Plane, Pos, Rot, ThreePointArc, extrude, make_face


def along_y(radius, y0, y1, x, z):
    return Pos(x, (y0 + y1) / 2, z) * Rot(X=90) * Cylinder(radius, abs(y1 - y0))


def build(part):
    d = part.dimensions
    w, top = d["half_width"], d["top_z"]
    inner, outer = d["leg_inner_y"], d["leg_outer_y"]
    thick = outer - inner
    mid = (inner + outer) / 2
    a, b = (-w, -d["foot_long"]), (w, -d["foot_short"])
    c, e = (w, top), (-w, top)
    face = make_face([Line(a, b), Line(b, c), ThreePointArc(c, (0, top + w), e), Line(e, a)])
    leg = extrude(Plane.XZ * face, amount=thick)  # y from 0 to -thick
    shape = Pos(0, outer, 0) * leg
    shape += along_y(d["rod_radius"], -mid, mid, 0, top)
    shape += Pos(0, -inner, 0) * leg
    rail_x = d["rail_outer_x"] - d["rail_inner_x"]
    rail_z = d["rail_low"] - d["rail_high"]
    shape += Pos(
        -(d["rail_outer_x"] + d["rail_inner_x"]) / 2, 0, -(d["rail_low"] + d["rail_high"]) / 2
    ) * Box(rail_x, 2 * outer, rail_z)
    for s in (1, -1):
        shape += along_y(d["shoulder_radius"], s * (inner + thick / 4), s * d["shoulder_end_y"], 0, 0)
        shape += along_y(d["stub_radius"], s * mid, s * d["stub_end_y"], 0, 0)
        shape += along_y(d["brace_pin_radius"], s * mid, s * d["brace_pin_end_y"], 0, -d["brace_drop"])
    y, z = d["brace_mid_y"], -d["brace_drop"]
    return shape, {
        "pivot": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)},
        "seat_hinge": {"o": (0, 0, top), "z": (0, 1, 0), "x": (0, 0, 1)},
        "brace_pin_front": {"o": (0, -y, z), "z": (0, -1, 0), "x": (0, 0, -1)},
        "brace_pin_back": {"o": (0, y, z), "z": (0, -1, 0), "x": (0, 0, -1)},
    }
