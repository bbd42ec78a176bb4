from math import atan2, degrees

from build123d import Align, Box, Cylinder, Pos, Rot

CORNER = (Align.MIN, Align.MIN, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def arm_l(half, deep, seat, seat_z, seat_deep, arm_z, arm, arm_wide, post, hang_x, beam_z, rod, rod_y, rod_end_z, post_y=4, post_x=5, air=0.5):
    foot = seat_z + seat
    frame = Pos(post_x, post_y, 0) * Box(post, post, arm_z - foot, align=CORNER)
    frame += Pos(0, 0, arm_z - foot) * Box(arm_wide, seat_deep, arm, align=CORNER)
    drop = beam_z - rod_end_z
    for side in (-1, 1):
        hole = Rot(X=side * degrees(atan2(rod_y, drop))) * Cylinder(rod / 2 + air, drop, align=HIGH)
        frame -= Pos(half - hang_x, deep / 2, beam_z - foot) * hole
    return frame
