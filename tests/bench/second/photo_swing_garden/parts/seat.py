from math import atan2, degrees

from build123d import Align, Box, Cylinder, Pos, Rot

BACK = (Align.CENTER, Align.MAX, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def seat(half, deep, seat, seat_z, hang_x, beam_z, rod, rod_y, rod_end_z):
    board = Box(2 * half, deep, seat, align=BACK)
    drop = beam_z - rod_end_z
    for side in (-1, 1):
        hole = Rot(X=side * degrees(atan2(rod_y, drop))) * Cylinder(rod / 2, drop + 2 * rod, align=HIGH)
        hole -= Pos(Z=-drop) * Box(8 * rod, 4 * rod_y, 8 * rod, align=HIGH)
        for x in (-hang_x, hang_x):
            board -= Pos(x, -deep / 2, beam_z - seat_z) * hole
    return board
