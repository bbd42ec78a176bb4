from build123d import Align, Box, Cylinder, Line, Pos, Rot, ThreePointArc, extrude, make_face

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    hw, h, so = d["half_width"], d["height"], d["spindle_offset"]
    outline = make_face([
        Line((hw, -so), (hw, 0)),
        ThreePointArc((hw, 0), (0, hw), (-hw, 0)),
        Line((-hw, 0), (-hw, -so)),
        ThreePointArc((-hw, -so), (0, -so - hw), (hw, -so)),
    ])
    deck_z = d["deck_z"]
    shape = extrude(outline, amount=h)
    if shape.bounding_box().min.Z < -h / 2:
        shape = Pos(0, 0, h) * shape
    shape += Pos(0, 0, deck_z) * Box(
        2 * d["deck_half"], d["deck_back"], h - deck_z, align=(Align.CENTER, Align.MIN, Align.MIN)
    )
    shape -= Pos(0, 0, -1) * Cylinder(d["column_radius"], d["column_depth"] + 1, align=UP)
    shape -= Pos(0, -so, -1) * Cylinder(d["quill_bore"], deck_z + 1, align=UP)
    shape -= Pos(0, -so, deck_z - 1) * Cylinder(d["pulley_bore"], h - deck_z + 2, align=UP)
    mo = d["motor_offset"]
    shape -= Pos(0, mo, deck_z - 1) * Cylinder(d["shaft_hole"], h - deck_z + 2, align=UP)
    fo, fz, start = d["feed_offset"], d["feed_z"], d["wide_start"]
    shape -= Pos(start, -fo, fz) * Rot(Y=90) * Cylinder(d["feed_bore_wide"], hw - start + 1, align=UP)
    shape -= Pos(-hw - 1, -fo, fz) * Rot(Y=90) * Cylinder(d["feed_bore_narrow"], hw + 1 + start + 1, align=UP)
    return shape, {
        "column": {"o": (0, 0, d["column_depth"]), "z": (0, 0, 1), "x": (1, 0, 0)},
        "motor": {"o": (0, mo, deck_z), "z": (0, 0, 1), "x": (1, 0, 0)},
        "pulley": {"o": (0, -so, h), "z": (0, 0, 1), "x": (1, 0, 0)},
        "quill": {"o": (0, -so, d["quill_z"]), "z": (0, 0, -1), "x": (1, 0, 0)},
        "feed": {"o": (0, -fo, fz), "z": (1, 0, 0), "x": (0, 1, 0)},
    }
