from build123d import Align, Box, Cylinder, Pos, Rot

FRONT = (Align.CENTER, Align.MIN, Align.MIN)


def top(high, knob_z, open_wide, side_gap, front, tang, long=285, side=8, floor=6):
    wide = open_wide - 2 * side_gap
    drawer = Box(wide, long, high, align=FRONT)
    drawer -= Pos(0, front, floor) * Box(wide - 2 * side, long - front - side, high, align=FRONT)
    return drawer - Pos(0, 0, knob_z) * Rot(X=90) * Cylinder(tang / 2, 2 * front + 0.2)
