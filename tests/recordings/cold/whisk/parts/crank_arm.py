from build123d import Align, Box, Cylinder, Pos

UP = (Align.CENTER, Align.CENTER, Align.MIN)
SIDE = (Align.MIN, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    thickness, throw = d["thickness"], d["throw"]
    shape = Cylinder(d["hub_radius"], thickness, align=UP)
    shape += Box(throw, 2 * d["half_width"], thickness, align=SIDE)
    shape += Pos(throw, 0, 0) * Cylinder(d["eye_radius"], thickness, align=UP)
    r = d["bore_radius"]
    bore = Pos(0, 0, -1) * Cylinder(r, thickness + 2, align=UP)
    bore -= Pos(d["flat_distance"], 0, -2) * Box(4 * r, 4 * r, thickness + 4, align=SIDE)
    shape -= bore
    shape -= Pos(throw, 0, -1) * Cylinder(d["pin_hole_radius"], thickness + 2, align=UP)
    up, x = (0, 0, 1), (1, 0, 0)
    return shape, {
        "seat": {"o": (0, 0, 0), "z": up, "x": x},
        "pin": {"o": (throw, 0, 0), "z": up, "x": x},
    }
