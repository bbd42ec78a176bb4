"""Arms lie in XZ, their back face at y = 0; pins of foot and head point to the front, those of the blocks to the back."""

from math import cos, radians

from build123d import Align, Axis, Box, Circle, Cylinder, Pos, Rot, SlotCenterToCenter, chamfer, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)
HANG = (Align.CENTER, Align.CENTER, Align.MAX)
FLAT = Rot(90, 0, 0)


def stud(x, z, radius, back, front):
    return Pos(x, back, z) * FLAT * Cylinder(radius, back - front, align=UP)


def along_x(radius, low, high):
    return Pos(X=(low + high) / 2) * Rot(0, 90, 0) * Cylinder(radius, high - low)


def foot(foot_z, half, air, thick, pin_d, plate=7, long=70, deep=90, web=9):
    body = Box(long, deep, plate, align=UP)
    body = chamfer(body.edges().filter_by(Axis.Z), 3)
    body += Pos(0, 0, plate - 1) * Box(48, web, foot_z + 13 - plate, align=(Align.CENTER, Align.MIN, Align.MIN))
    for x in (-half, half):
        body += stud(x, foot_z, pin_d / 2, web / 2, -air - thick)
    return body


def head(head_h, half, air, layer, thick, pin_d, plate=8, web=9):
    body = Pos(0, 0, head_h) * Box(60, 50, plate, align=HANG)
    body = chamfer(body.edges().filter_by(Axis.Z), 3)
    body += Pos(0, 0, -13) * Box(48, web, head_h + 14 - plate, align=(Align.CENTER, Align.MIN, Align.MIN))
    for x in (-half, half):
        body += stud(x, 0, pin_d / 2, web / 2, -air - layer - thick) + stud(x, 0, pin_d / 2 + 3, web / 2, -layer)
    return body


def arm(arm, wide, thick, pin_d, play):
    hole = Circle(pin_d / 2 + play)
    flat = Pos(arm / 2, 0) * SlotCenterToCenter(arm, wide) - hole - Pos(arm, 0) * hole
    return FLAT * extrude(flat, thick)


arm_low = arm_up = arm_low_left = arm_up_left = arm_low_right = arm_up_right = arm


def nut(block, rod_y, pin_d, rod_d, play):
    """A block about the screw with the pin of both arms."""
    body = Box(block, 15, 25)
    body = chamfer(body.edges().filter_by(Axis.Y), 2)
    body -= along_x(rod_d / 2 + play, -block, block)
    return body + stud(0, 0, pin_d / 2, -rod_y, rod_d / 2 + 2)


trunnion = nut


def screw(arm, block, rod_d, lowest, half):
    """From the trunnion's middle: the rod to the left, through the nut at its farthest; at the right a head with a bar."""
    far = 2 * (half + arm * cos(radians(lowest))) + block / 2 + 11
    body = along_x(rod_d / 2, -far, block / 2 + 10)
    body = chamfer(body.edges().group_by(Axis.X)[0], 1)
    body += along_x(8, block / 2 + 0.3, block / 2 + 12.6)
    return body + Pos(block / 2 + 6.5) * Cylinder(3, 40)
