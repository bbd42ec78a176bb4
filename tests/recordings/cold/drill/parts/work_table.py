from build123d import Align, Box, Cylinder, Pos, Rot

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    half, centre, height = d["plate_half"], d["centre"], d["collar_height"]
    shape = Pos(0, -centre, 0) * Box(2 * half, 2 * half, d["plate_thickness"], align=DOWN)
    shape += Pos(0, 0, -height) * Box(
        2 * d["arm_half"], d["arm_front"], height - d["arm_top"], align=(Align.CENTER, Align.MAX, Align.MIN)
    )
    shape += Cylinder(d["collar_radius"], height, align=DOWN)
    boss_start = d["collar_radius"] - 8
    shape += Pos(boss_start, 0, -d["clamp_z"]) * Rot(Y=90) * Cylinder(
        d["boss_radius"], d["boss_end"] - boss_start, align=UP
    )
    shape -= Pos(0, 0, 1) * Cylinder(d["bore_radius"], height + 2, align=DOWN)
    shape -= Pos(0, -centre, 1) * Cylinder(d["drill_radius"], height + 2, align=DOWN)
    slot = Box(
        d["slot_out"] - d["slot_in"], 2 * d["slot_half"], d["plate_thickness"] + 2,
        align=(Align.MIN, Align.CENTER, Align.MAX),
    )
    shape -= Pos(d["slot_in"], -centre, 1) * slot
    shape -= Pos(-d["slot_out"], -centre, 1) * slot
    shape -= Pos(0, 0, -d["clamp_z"]) * Rot(Y=90) * Cylinder(d["clamp_hole"], d["boss_end"] + 2, align=UP)
    return shape, {
        "collar": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "clamp": {"o": (d["clamp_x"], 0, -d["clamp_z"]), "z": (-1, 0, 0), "x": (0, 1, 0)},
    }
