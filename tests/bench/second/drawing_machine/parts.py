"""Gears turn about z, their pins on x; a pin has a shoulder below its bar. The pen hangs from the left bar."""

from build123d import Align, Axis, Box, Circle, Cone, Cylinder, Pos, SlotCenterToCenter, chamfer, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def peg(low, high, radius):
    body = Pos(0, 0, low) * Cylinder(radius, high - low, align=UP)
    return chamfer(body.edges().group_by(Axis.Z)[-1], 0.5)


def table(apart, gear_z, thick, stud, top=18):
    body = Box(300, 290, top, align=(Align.CENTER, Align.CENTER, Align.MAX)).moved(Pos(apart / 2, 50, 0))
    body = chamfer(body.edges().filter_by(Axis.Z), 4)
    for x in (0, apart):
        body += Pos(x, 0, 0) * (peg(-top / 2, gear_z + thick, stud / 2) + peg(-top / 2, gear_z - 0.2, stud / 2 + 6))
    return body


def gear(across, pin_at, stud, thick, pin_d, play, foot, tall):
    disc = Cylinder(across / 2, thick, align=UP)
    disc = chamfer(disc.edges().group_by(Axis.Z)[-1], 0.6) - Cylinder(stud / 2 + play, thick, align=UP)
    return disc + Pos(pin_at, 0, 0) * (peg(thick / 2, tall, pin_d / 2) + peg(thick / 2, foot, pin_d / 2 + 2))


gear_left = gear_right = gear


def bar_left(left_bar, wide, bar, low, air, pin_d, play, pen=8):
    body = extrude(Pos(left_bar / 2, 0) * SlotCenterToCenter(left_bar, wide) - Circle(pin_d / 2 + play), bar)
    body += Pos(left_bar, 0, 0) * (peg(bar / 2, 2 * bar + air + 1, pin_d / 2) + peg(bar / 2, bar + air / 2, pin_d / 2 + 2))
    tip = Pos(0, 0, bar / 2) * Cylinder(pen / 2, bar / 2 + low - 6, align=DOWN) + Pos(0, 0, 0.4 - low) * Cone(0.5, pen / 2, 5.6, align=UP)
    return body + Pos(left_bar, 0, 0) * tip


def bar_right(right_bar, wide, bar, pin_d, play):
    hole = Circle(pin_d / 2 + play)
    return extrude(Pos(right_bar / 2, 0) * SlotCenterToCenter(right_bar, wide) - hole - Pos(right_bar, 0) * hole, bar)
