from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    side, height, floor, hollow, boss = d["side"], d["height"], d["floor"], d["hollow"], d["boss"]
    pivot, worm_bore, worm_y, worm_z = d["pivot"], d["worm_bore"], d["worm_y"], d["worm_z"]
    shape = Box(side, side, height, align=LOW) - Pos(0, 0, floor) * Cylinder(hollow / 2, height, align=LOW)
    shape += Cylinder(boss / 2, height, align=LOW)
    shape -= Pos(0, 0, floor / 2) * Cylinder(pivot / 2, height, align=LOW)
    shape -= Pos(0, worm_y, worm_z) * Rot(Y=90) * Cylinder(worm_bore / 2, 2 * side)
    return shape, {
        "table": {"o": (0, 0, height), "z": (0, 0, 1), "x": (1, 0, 0)},
        "worm": {"o": (side/2, worm_y, worm_z), "z": (1, 0, 0), "x": (0, 1, 0)},
    }
