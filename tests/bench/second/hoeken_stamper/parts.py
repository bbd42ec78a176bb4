"""Bars lie in XZ with their back face at y = 0; pins point to the front."""

from build123d import Align, Axis, Box, Circle, Cylinder, Pos, Rot, SlotCenterToCenter, chamfer, extrude, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)
LOW = (Align.MIN, Align.MIN, Align.MIN)
FLAT = Rot(90, 0, 0)


def stud(x, z, radius, back, front):
    body = Pos(x, back, z) * FLAT * Cylinder(radius, back - front, align=UP)
    return chamfer(body.edges().group_by(Axis.Y)[0], 0.4)


def strip(long, wide, thick, bores, radius):
    flat = Pos(long / 2, 0) * SlotCenterToCenter(long, wide)
    for x in bores:
        flat -= Pos(x, 0) * Circle(radius)
    return FLAT * extrude(flat, thick)


def board(ax, az, apart, wall_y, layer, pin_d, long=300, deep=70, foot=15, wall=8, high=135):
    body = Box(long, deep, foot, align=LOW)
    body = chamfer(body.edges().filter_by(Axis.Z), 4)
    body += Pos(0, wall_y, foot / 2) * Box(long, wall, high - foot / 2, align=LOW)
    for x in (ax, ax + apart):
        body += stud(x, az, pin_d / 2, wall_y + wall / 2, wall_y - layer)
    return body


def crank(crank, wide, thick, layer, pin_d, play):
    return strip(crank, wide, thick, [0], pin_d / 2 + play) + stud(crank, 0, pin_d / 2, -thick / 2, -thick - layer)


def rocker(half, wide, thick, layer, pin_d, play):
    return strip(half, wide, thick, [0], pin_d / 2 + play) + stud(half, 0, pin_d / 2, -thick / 2, -thick - layer)


def coupler(half, wide, thick, pin_d, play):
    return strip(2 * half, wide, thick, [0, half], pin_d / 2 + play)


def stamp(stamp, tall=7):
    body = FLAT * Cylinder(stamp / 2, tall, align=UP)
    return fillet(body.edges().group_by(Axis.Y)[0], 1)
