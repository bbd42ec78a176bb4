from build123d import Align, Box, Cylinder, Pos, Rot

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    w, depth, h = d["width"], d["depth"], d["height"]
    ft, az = d["flange_thickness"], d["axis_z"]
    ch, gh = d["channel_half"], d["groove_half"]
    shape = Box(w, depth, h, align=UP)
    shape += Pos(0, 0, -ft) * Cylinder(d["flange_radius"], ft + 1, align=UP)
    shape -= Pos(0, 0, d["channel_floor"]) * Box(w + 2, 2 * ch, h, align=UP)
    shape -= Pos(0, 0, d["groove_bottom"]) * Box(w + 2, 2 * gh, d["groove_top"] - d["groove_bottom"], align=UP)
    shape -= Pos(0, 0, az) * Rot(X=-90) * Cylinder(d["bush_radius"], depth / 2 + 1, align=UP)
    shape -= Pos(0, 0, az) * Rot(X=90) * Cylinder(d["journal_bore_radius"], d["journal_bore_end"], align=UP)
    for sx in (-1, 1):
        for sy in (-1, 1):
            shape -= Pos(sx * d["bolt_offset"], sy * d["bolt_offset"], -ft - 1) * Cylinder(
                d["bolt_radius"], d["bolt_depth"] + 1, align=UP)
    shape -= Pos(0, 0, -ft - 1) * Cylinder(d["recess_radius"], d["recess_depth"] + 1, align=UP)
    c = part.connectors
    return shape, {
        "jaw_right": {"o": (0, 0, az), "z": c["jaw_right"].z, "x": c["jaw_right"].x},
        "jaw_left": {"o": (0, 0, az), "z": c["jaw_left"].z, "x": c["jaw_left"].x},
        "pinion": {"o": (0, 0, az), "z": c["pinion"].z, "x": c["pinion"].x},
        "bush": {"o": (0, depth / 2, az), "z": c["bush"].z, "x": c["bush"].x},
    }
