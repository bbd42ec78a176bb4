from build123d import Box, Cylinder, Line, Plane, Pos, Rot, ThreePointArc, extrude, make_face


def build(part):
    d = part.dimensions
    w, length, t = d["half_width"], d["length"], d["thickness"]
    a, b, c, e = (0, -w), (length, -w), (length, w), (0, w)
    face = make_face([Line(a, b), Line(b, c), Line(c, e), ThreePointArc(e, (-w, 0), a)])
    shape = extrude(Plane.XZ * face, amount=t / 2, both=True)
    shape -= Rot(X=90) * Cylinder(d["bore_radius"], t + 2)
    x0, x1 = d["slot_start"], d["slot_end"]
    shape -= Pos((x0 + x1) / 2, 0, 0) * Box(x1 - x0, t + 2, 2 * d["slot_half_height"])
    return shape, {
        "hinge": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "slot": {"o": (d["slot_rest"], 0, 0), "z": (-1, 0, 0), "x": (0, 0, 1)},
    }
