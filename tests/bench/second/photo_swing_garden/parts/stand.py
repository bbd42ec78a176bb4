from math import atan2, degrees, hypot

from build123d import Align, Box, Cylinder, Pos, Rot

HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def stand(beam_z, beam, beam_long, leg=60, leg_x=950, foot_y=610, tie=40, tie_z=322):
    frame = Pos(Z=beam_z) * Rot(Y=90) * Cylinder(beam / 2, beam_long)
    lean = degrees(atan2(foot_y, beam_z))
    tie_y = foot_y * (beam_z - tie_z) / beam_z
    for x in (-leg_x, leg_x):
        for side in (-1, 1):
            frame += Pos(x, 0, beam_z) * Rot(X=side * lean) * Cylinder(leg / 2, hypot(foot_y, beam_z) + leg, align=HIGH)
        frame += Pos(x, 0, tie_z) * Rot(X=90) * Cylinder(tie / 2, 2 * tie_y)
    return frame - Box(2 * beam_long, 4 * foot_y, 4 * leg, align=HIGH)
