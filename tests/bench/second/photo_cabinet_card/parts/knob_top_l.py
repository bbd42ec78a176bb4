from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def knob_top_l(tang, front, disc=26, thick=12, neck=12, neck_long=12):
    knob = Pos(Z=-front) * Cylinder(tang / 2, front + neck_long, align=LOW)
    return knob + Cylinder(neck / 2, neck_long, align=LOW) + Pos(Z=neck_long) * Cylinder(disc / 2, thick, align=LOW)
