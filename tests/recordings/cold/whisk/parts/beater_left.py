from build123d import Align, Axis, Box, Cylinder, Pos, Rot, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)
SIDE = (Align.MIN, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    t, width, tall = d["blade_thickness"], d["blade_width"], d["cage_height"]
    radius, corner = d["blade_radius"], d["corner_radius"]

    outer = Box(2 * radius, width, tall, align=UP)
    outer = fillet(outer.edges().filter_by(Axis.Y), radius=corner)
    inner = Pos(0, 0, t) * Box(2 * (radius - t), width + 2, tall - 2 * t, align=UP)
    inner = fillet(inner.edges().filter_by(Axis.Y), radius=corner - t)
    loop = outer - inner

    sr, wide = d["shaft_radius"], 4 * d["collar_radius"]
    bottom, seat, flat_top, top = d["shaft_bottom"], d["seat_z"], d["flat_top"], d["top"]
    shaft = Pos(0, 0, bottom) * Cylinder(sr, flat_top - bottom, align=UP)
    shaft -= Pos(d["flat_distance"], 0, seat) * Box(wide, wide, flat_top - seat + 1, align=SIDE)
    shaft += Pos(0, 0, d["collar_bottom"]) * Cylinder(
        d["collar_radius"], d["collar_top"] - d["collar_bottom"], align=UP
    )
    shaft += Pos(0, 0, flat_top - 1) * Cylinder(d["journal_radius"], top - flat_top + 1, align=UP)

    shape = loop + Rot(Z=90) * loop
    shape += Cylinder(d["hub_radius"], d["hub_height"], align=UP)
    shape += shaft
    up, x = (0, 0, 1), (1, 0, 0)
    return shape, {
        "axis": {"o": (0, 0, d["bearing_z"]), "z": up, "x": x},
        "pinion": {"o": (0, 0, seat), "z": up, "x": x},
    }
