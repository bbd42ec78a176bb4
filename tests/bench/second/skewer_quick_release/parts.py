from math import cos, radians, sin

from build123d import Align, Axis, Box, Cylinder, Pos, Rot, chamfer, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def along_x(start, end, radius):
    return Pos(start, 0, 0) * Rot(Y=90) * Cylinder(radius, end - start, align=UP)


def rod(rod_d, between, nut, sunk=4):
    """Its end at -sunk is pressed into the cap."""
    return chamfer(along_x(-sunk, between + nut + 7, rod_d / 2).edges().group_by(Axis.X)[-1], 0.6)


def cap(rod_d, cam_x, drum_d, play, slot, cap_d, cap_long, sunk=4):
    """A drum turned about x with a bore across for the cam and a slot for the lever's arm, open above, behind and below."""
    body = along_x(-cap_long, 0, cap_d / 2)
    body = fillet(body.edges().group_by(Axis.X)[0], 2)
    body -= along_x(-sunk, 1, rod_d / 2)
    body -= Pos(-cam_x, 0, 0) * Rot(X=90) * Cylinder(drum_d / 2 + play, 2 * cap_d)
    return body - Pos(-cam_x + drum_d / 2 - 1, 0, 0) * Box(2 * cap_d, slot, 2 * cap_d, align=(Align.MAX, Align.CENTER, Align.CENTER))


def lever(drum_d, slot, cap_d, long=62, arm=10):
    """Drum about y, the arm upwards; the arm fills the slot, so the drum cannot leave along y."""
    body = Rot(X=90) * Cylinder(drum_d / 2, cap_d - 4)
    thick = slot - 0.6
    blade = Box(arm, thick, long, align=UP) + Pos(0, 0, long) * Rot(X=90) * Cylinder(arm / 2, thick)
    grip = Pos(0, 0, (long + 20) / 2 + 5) * Box(arm, 14, long - 24)
    return body + blade + fillet(grip.edges().filter_by(Axis.Z), 3)


def nut(rod_d, nut, across=20, ribs_count=20):
    """From z = 0, ribbed outside."""
    body = chamfer(Cylinder(across / 2, nut, align=UP).edges().group_by(Axis.Z)[-1], 1)
    for i in range(ribs_count):
        a = radians(360 * i / ribs_count)
        body -= Pos(across / 2 * cos(a), across / 2 * sin(a), 3) * Cylinder(0.8, nut, align=UP)
    return body - Cylinder(rod_d / 2 + 0.1, 4 * nut)
