from build123d import Align, Box, Cylinder, Pos

SIDE = (Align.MIN, Align.CENTER, Align.MIN)
UP = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    hd, fh, seat = d["half_depth"], d["foot_height"], d["seat_z"]
    shape = Box(d["blade"], 2 * hd, d["length"], align=SIDE)
    shape += Box(d["foot_length"], 2 * hd, fh, align=SIDE)
    for x in (d["hole_in"], d["hole_out"]):
        shape -= Pos(x, 0, -1) * Cylinder(d["hole_radius"], fh + 2, align=UP)
        shape -= Pos(x, 0, seat) * Cylinder(d["counterbore_radius"], fh - seat + 1, align=UP)
    c = part.connectors
    return shape, {
        "foot": {"o": (d["blade"] / 2, 0, 0), "z": c["foot"].z, "x": c["foot"].x},
        "screw_inner": {"o": (d["hole_in"], 0, seat), "z": c["screw_inner"].z, "x": c["screw_inner"].x},
        "screw_outer": {"o": (d["hole_out"], 0, seat), "z": c["screw_outer"].z, "x": c["screw_outer"].x},
    }
