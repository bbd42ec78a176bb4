from build123d import Align, Box, Cylinder, Pos, RectangleRounded, Rot, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length, thick, height = d["length"], d["thickness"], d["height"]

    # rounded on the outer side (-Y) only: the inner half of a bar of double thickness is cut away
    shape = Pos(0, thick / 2, 0) * extrude(
        RectangleRounded(length, 2 * thick, d["corner_radius"]), amount=height
    )
    shape -= Pos(0, thick / 2, -1) * Box(
        length + 2, 2 * thick, height + 2, align=(Align.CENTER, Align.MIN, Align.MIN)
    )

    into = height / 4
    for k in (-1.5, -0.5, 0.5, 1.5):
        x = k * d["rod_spacing"]
        tongue = Pos(x, 0, -d["tongue_depth"]) * Box(d["tongue_width"], thick, d["tongue_depth"] + into, align=UP)
        tongue -= Pos(x, 0, -d["axis_drop"]) * Rot(X=90) * Cylinder(d["bore_radius"], thick + 2)
        shape += tongue
    for x in (-d["peg_x"], 0, d["peg_x"]):
        shape += Pos(x, 0, -d["peg_length"]) * Cylinder(d["peg_radius"], d["peg_length"] + into, align=UP)
    return shape, {"seat": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
