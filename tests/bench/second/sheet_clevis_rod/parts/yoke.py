from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def yoke(bore, slot, cheek, reach=80, shank=18, shank_length=46, drill=8.5, drill_depth=22, wide=26, slot_depth=31):
    high = slot + 2 * cheek
    across = Pos(Z=reach) * Rot(Y=90)
    body = Pos(Z=shank_length) * Box(high, wide, reach - shank_length, align=LOW) + across * Cylinder(wide / 2, high)
    body += Cylinder(shank / 2, shank_length, align=LOW)
    body -= Cylinder(drill / 2, drill_depth, align=LOW)
    body -= Pos(Z=reach + wide / 2 - slot_depth) * Box(slot, 2 * wide, 2 * slot_depth, align=LOW)
    return body - across * Cylinder(bore / 2, 2 * high)
