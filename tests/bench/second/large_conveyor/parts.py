"""Rails, legs and rollers of the conveyor; side 1 is the back (+y), -1 the front."""

from build123d import Align, Box, Cylinder, GeomType, Pos, Rot, chamfer

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def along_y(diameter, long):
    return Rot(90, 0, 0) * Cylinder(diameter / 2, long)


def rail(side, long, rail_high, flange, web, pitch, axle_d):
    """Channel whose web begins at y = 0 and whose flanges point to the side."""
    body = Pos(0, side * flange / 2, 0) * Box(long, flange, rail_high)
    body -= Pos(0, side * (web + flange / 2), 0) * Box(2 * long, flange, rail_high - 2 * web)
    for i in range(12):
        body -= Pos((i - 5.5) * pitch, 0, 0) * along_y(axle_d, 4 * web)
    return body


def leg(leg_wide, leg_deep, wall, rail_z, leg_low, stem_d, plug=30):
    """Tube below z = 0, with a plug at its foot for the stem."""
    high = rail_z - leg_low
    body = Box(leg_wide, leg_deep, high, align=DOWN)
    body -= Pos(0, 0, plug - high) * Box(leg_wide - 2 * wall, leg_deep - 2 * wall, high, align=UP)
    return body - Pos(0, 0, -high) * Cylinder(stem_d / 2, 3 * plug)


def foot(foot_d, stem_d, foot_high, disc=14):
    return Cylinder(foot_d / 2, disc, align=UP) + Cylinder(stem_d / 2, foot_high, align=UP)


def tie(tie_long, leg_wide, leg_deep, wall):
    """Upright tube along y."""
    return Box(leg_deep, tie_long, leg_wide) - Box(leg_deep - 2 * wall, 2 * tie_long, leg_wide - 2 * wall)


def axle(axle_d, axle_long, screw_d, screw_in, bevel=0.5):
    body = along_y(axle_d, axle_long)
    body = chamfer(body.edges().filter_by(GeomType.CIRCLE), bevel)
    for side in (-1, 1):
        body -= Pos(0, side * axle_long / 2, 0) * along_y(screw_d, 2 * screw_in)
    return body


def screw(side, screw_d, screw_in, screw_head, head_high):
    body = Pos(0, side * head_high / 2, 0) * along_y(screw_head, head_high)
    return body + Pos(0, side * (1 - screw_in) / 2, 0) * along_y(screw_d, screw_in + 1)


def bearing(bearing_d, bearing_wide, axle_d):
    return along_y(bearing_d, bearing_wide) - along_y(axle_d, 2 * bearing_wide)


def roller(roller_d, roller_long, bearing_d, play, seat_deep, axle_d, shell=3, end=18):
    """Tube with thick ends, in which the bearings have their seats."""
    body = along_y(roller_d, roller_long)
    body -= along_y(roller_d - 2 * shell, roller_long - 2 * end) + along_y(axle_d + 4, 2 * roller_long)
    for side in (-1, 1):
        body -= Pos(0, side * roller_long / 2, 0) * along_y(bearing_d + play, 2 * seat_deep)
    return body
