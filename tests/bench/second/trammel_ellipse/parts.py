"""Shuttles and arm have z = 0 at the arm's lower face."""

from build123d import Align, Axis, Box, Circle, Cylinder, Pos, SlotCenterToCenter, chamfer, extrude, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def board(board, groove, groove_z, side=148):
    body = Box(side, side, board, align=UP)
    body = chamfer(body.edges().filter_by(Axis.Z), 2)
    for x, y in ((groove, 2 * side), (2 * side, groove)):
        body -= Pos(0, 0, groove_z) * Box(x, y, board, align=UP)
    return body


def shuttle(groove, groove_z, play, arm_z, arm, pin_d, long=24):
    low, high = groove_z + 0.2 - arm_z, -0.3
    body = Pos(0, 0, low) * Box(long, groove - 2 * play, high - low, align=UP)
    body = chamfer(body.edges().filter_by(Axis.Z), 0.5)
    pin = Pos(0, 0, high - 2) * Cylinder(pin_d / 2, arm + 2 - high, align=UP)
    return body + chamfer(pin.edges().group_by(Axis.Z)[-1], 0.4)


def arm(apart, beyond, arm, pin_d, bore_play, wide=18, knob=8, knob_high=10):
    reach = apart + beyond
    flat = Pos(reach / 2, 0) * SlotCenterToCenter(reach, wide)
    for x in (0, apart):
        flat -= Pos(x, 0) * Circle(pin_d / 2 + bore_play)
    grip = Pos(reach, 0, arm - 1) * Cylinder(knob / 2, knob_high + 1, align=UP)
    return extrude(flat, arm) + fillet(grip.edges().group_by(Axis.Z)[-1], 1)
