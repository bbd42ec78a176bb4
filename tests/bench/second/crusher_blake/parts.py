"""Bars lie along x in XZ, their back face at y = 0; pins point to the front."""

from build123d import Align, Axis, Box, Circle, Cylinder, Pos, Rot, SlotCenterToCenter, chamfer, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)
FLAT = Rot(90, 0, 0)


def stud(x, z, radius, back, front):
    return Pos(x, back, z) * FLAT * Cylinder(radius, back - front, align=UP)


def frame(crank_x, crank_z, jaw_x, jaw_z, rear_x, rear_z, wheel_y, jaw_y, rear_y, thick, air, pin_d, long=300, deep=100, tall=276, foot=15, board=12):
    body = Pos(long / 2, board / 2, 0) * Box(long, deep, foot, align=UP)
    body = chamfer(body.edges().filter_by(Axis.Z), 3)
    body += Pos(long / 2, board / 2, 0) * Box(long, board, tall, align=UP)
    body += stud(crank_x, crank_z, pin_d / 2, 1, wheel_y - thick)
    for x, z, y in ((jaw_x, jaw_z, jaw_y), (rear_x, rear_z, rear_y)):
        body += stud(x, z, 7, 1, y + air) + stud(x, z, pin_d / 2, 1, y - thick)
    return body


def flywheel(throw, wheel_d, thick, air, pin_d, play):
    body = FLAT * extrude(Circle(wheel_d / 2) - Circle(pin_d / 2 + play), thick)
    return body + stud(throw, 0, pin_d / 2, -1, -2 * thick - air)


def bar(length, end_r, thick, holes, pin_d, play):
    flat = Pos(length / 2, 0) * SlotCenterToCenter(length, 2 * end_r)
    for x in holes:
        flat -= Pos(x, 0) * Circle(pin_d / 2 + play)
    return FLAT * extrude(flat, thick)


def pitman(pitman_long, end_r, thick, air, pin_d, play):
    """Its lower pin goes through both toggles."""
    return bar(pitman_long, end_r, thick, [0], pin_d, play) + stud(pitman_long, 0, pin_d / 2, -1, -3 * thick - 2 * air)


def toggle_rear(rear_long, end_r, thick, pin_d, play):
    return bar(rear_long, end_r, thick, [0, rear_long], pin_d, play)


def toggle_front(front_long, end_r, thick, pin_d, play):
    return bar(front_long, end_r, thick, [0, front_long], pin_d, play)


def swing_jaw(jaw_long, end_r, thick, air, pin_d, play, plate_from=38, plate_long=95, plate=5):
    body = bar(jaw_long, end_r, thick, [0], pin_d, play) + stud(jaw_long, 0, pin_d / 2, -1, -2 * thick - air)
    return body + Pos(plate_from, -thick + 1, 0) * Box(plate_long, plate + 1, 16, align=(Align.MIN, Align.MAX, Align.CENTER))
