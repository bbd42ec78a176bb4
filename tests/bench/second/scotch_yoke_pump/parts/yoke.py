from build123d import Align, Box, Cylinder, Pos, Rectangle, Rot, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def yoke(
    throw, gap, plate, yoke_y, rod_y, rod_z, rod_d, block_wide, block_high, wide=48, guide_high=16, guide_deep=20, plunger_d=12, tip=120
):
    """Frame with a slot, in XY; a bearing on each rod and a plunger along +x."""
    window = Rectangle(block_wide + 2 * gap, 2 * throw + block_high + 6)
    body = extrude(Rectangle(wide, 2 * rod_z) - window, plate)
    rod = yoke_y - rod_y
    for side in (-1, 1):
        body += Pos(0, side * rod_z, rod) * Box(wide, guide_high, guide_deep)
    for side in (-1, 1):
        body -= Pos(0, side * rod_z, rod) * Rot(Y=90) * Cylinder(rod_d / 2 + gap, 2 * wide)
    return body + Pos(wide / 2 - 7, 0, plate + 1.7) * Rot(Y=90) * Cylinder(plunger_d / 2, tip - wide / 2 + 7, align=UP)
