from build123d import Align, Box, Cylinder, Pos

UP = (Align.CENTER, Align.CENTER, Align.MIN)
SIDE = (Align.MIN, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    r, journal = d["shaft_radius"], d["journal_radius"]
    gear_top, arm_seat, top = d["gear_flat_top"], d["arm_seat"], d["top"]
    wide = 4 * d["collar_radius"]

    shape = Cylinder(r, gear_top, align=UP)
    shape -= Pos(d["flat_distance"], 0, d["collar_top"]) * Box(
        wide, wide, gear_top - d["collar_top"] + 1, align=SIDE
    )
    shape += Pos(0, 0, d["collar_bottom"]) * Cylinder(
        d["collar_radius"], d["collar_top"] - d["collar_bottom"], align=UP
    )
    shape += Pos(0, 0, gear_top - 1) * Cylinder(journal, top - gear_top + 1, align=UP)
    shape -= Pos(d["arm_flat_distance"], 0, arm_seat) * Box(
        wide, wide, top - arm_seat + 1, align=SIDE
    )

    def frame(z):
        return {"o": (0, 0, z), "z": (0, 0, 1), "x": (1, 0, 0)}

    return shape, {"axis": frame(0), "gear": frame(d["collar_top"]), "arm": frame(arm_seat)}
