from build123d import Align, Box, Cylinder, Pos

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def chassis(
    king, king_y, rack_y, rack_z, knuckle_z, pinion_y, pin_d, play, link, gap, floor_z, plate, deep=128, guide_x=163, guide=13, guide_wide=16, bar=6, bar_high=5
):
    """Plate with a bearing of the column, two guides of the rack and two king pins on posts."""
    top = floor_z + plate
    body = Pos(0, deep / 2, floor_z) * Box(king + 60, deep, plate, align=UP)
    body += Pos(0, pinion_y, floor_z) * Cylinder(pin_d / 2 + 5, rack_z - gap - floor_z, align=UP)
    body -= Pos(0, pinion_y, 0) * Cylinder(pin_d / 2 + play, 2 * rack_z, align=UP)
    for side in (-1, 1):
        body += Pos(side * guide_x, rack_y, top - 1) * Box(guide, guide_wide, rack_z + link - top + 0.9, align=UP)
        body += Pos(side * king / 2, king_y, top - 1) * Cylinder(pin_d / 2 + 3, knuckle_z - gap - top + 1, align=UP)
        body += Pos(side * king / 2, king_y, top - 1) * Cylinder(pin_d / 2, knuckle_z + link + 1 - top, align=UP)
    return body - Pos(0, rack_y, rack_z + 3.5) * Box(2 * guide_x + 2 * guide, bar + 2 * play, bar_high + 2 * play)
