"""Bars lie along x in XZ, their back face at y = 0; pins point to the front."""

from build123d import Align, Axis, Box, Circle, Cylinder, Pos, Rot, SlotCenterToCenter, chamfer, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)
FLAT = Rot(90, 0, 0)


def stud(x, z, radius, back, front):
    return Pos(x, back, z) * FLAT * Cylinder(radius, back - front, align=UP)


def board(pivot_x, pivot_z, apart, thick, pin_d, y_1, y_2, y_3, air, long=220, deep=70, tall=236, foot=16, board=8, front=31):
    body = Pos(0, -front, 0) * Box(long, deep, foot, align=(Align.MIN, Align.MIN, Align.MIN))
    body = chamfer(body.edges().group_by(Axis.Z)[-1], 1.5)
    body += Box(long, board, tall, align=(Align.MIN, Align.MIN, Align.MIN))
    body += stud(pivot_x, pivot_z, 4.5, 1, y_2 + air) + stud(pivot_x, pivot_z, pin_d / 2, 1, y_3 - thick)
    return body + stud(pivot_x + apart, pivot_z, pin_d / 2, 1, y_1 - thick)


def bar(length, wide, thick, pin_d, play, holes):
    flat = Pos(length / 2, 0) * SlotCenterToCenter(length, wide)
    for x in holes:
        flat -= Pos(x, 0) * Circle(pin_d / 2 + play)
    return FLAT * extrude(flat, thick)


def pin(x, thick, air, pin_d, layers, more=0):
    return stud(x, 0, pin_d / 2, -thick / 2, -layers * thick - (layers - 1) * air - more)


def anchor_arm(anchor, wide, thick, air, pin_d, play):
    return bar(anchor, wide, thick, pin_d, play, [0]) + pin(anchor, thick, air, pin_d, 3)


def long_a(long_bar, wide, thick, air, pin_d, play):
    return bar(long_bar, wide, thick, pin_d, play, [0]) + pin(long_bar, thick, air, pin_d, 3)


def long_b(long_bar, wide, thick, pin_d, play):
    return bar(long_bar, wide, thick, pin_d, play, [0, long_bar])


def inner(side, wide, thick, pin_d, play):
    return bar(side, wide, thick, pin_d, play, [0, side])


def outer_a(side, wide, thick, pin_d, play):
    return bar(side, wide, thick, pin_d, play, [0, side])


def outer_b(side, wide, thick, air, pin_d, play, pen=10):
    """With the pen at the origin, through the other outer bar."""
    body = bar(side, wide, thick, pin_d, play, [])
    return body + pin(0, thick, air, pin_d, 4, pen) + pin(side, thick, air, pin_d, 3)
