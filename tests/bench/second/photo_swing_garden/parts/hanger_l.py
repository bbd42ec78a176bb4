from math import atan2, degrees

from build123d import Align, Box, Cylinder, Pos, Rot

HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def hanger_l(beam, beam_z, rod, rod_y, rod_end_z, ring=116, wide=36, play=0.5):
    drop = beam_z - rod_end_z
    hanger = Rot(Y=90) * Cylinder(ring / 2, wide)
    for side in (-1, 1):
        hanger += Rot(X=side * degrees(atan2(rod_y, drop))) * Cylinder(rod / 2, drop + 2 * rod, align=HIGH)
    hanger -= Rot(Y=90) * Cylinder(beam / 2 + play, 2 * wide)
    return hanger - Pos(Z=-drop) * Box(2 * ring, 4 * rod_y, 8 * rod, align=HIGH)
