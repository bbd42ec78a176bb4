"""The foot and the seat about z; a fork about its stem, a wheel about its axle along y."""

from build123d import Align, Axis, Box, Cylinder, Pos, Rot, chamfer, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def along_y(radius, long):
    return Rot(90, 0, 0) * Cylinder(radius, long)


def foot(arm, arm_wide, arm_low, arm_high, at, stem, column, play, tube, tube_low, tube_high):
    body = Pos(0, 0, tube_low) * Cylinder(tube / 2, tube_high - tube_low, align=UP)
    body = chamfer(body.edges().group_by(Axis.Z)[-1], 1)
    for k in range(5):
        beam = Pos(0, 0, arm_low) * Box(arm, arm_wide, arm_high, align=(Align.MIN, Align.CENTER, Align.MIN))
        beam -= Pos(at, 0, arm_low - 1) * Cylinder(stem / 2 + play, 2 * arm_high, align=UP)
        body += Rot(0, 0, 72 * k) * beam
    return body - Pos(0, 0, tube_low + 6) * Cylinder(column / 2 + play, tube_high, align=UP)


def seat(seat, seat_z, column, tube_low, thick=60):
    cushion = Pos(0, 0, seat_z) * Cylinder(seat / 2, thick, align=UP)
    cushion = fillet(cushion.edges().group_by(Axis.Z)[-1], 2)
    return cushion + Pos(0, 0, tube_low + 10) * Cylinder(column / 2, seat_z - tube_low, align=UP)


def fork(arm_low, arm_high, trail, wheel, tread, stem, axle, play, cheek=3):
    """Stem up into the arm, a plate with two cheeks down to the axle, which is riveted between them."""
    pin = Pos(0, 0, arm_low - 3) * Cylinder(stem / 2, arm_high, align=UP)
    body = chamfer(pin.edges().group_by(Axis.Z)[-1], 1)
    wide = tread + 1 + 2 * cheek
    body += Pos(-trail / 2, 0, arm_low - 4.5) * Box(trail + 18, wide, 4, align=UP)
    for side in (-1, 1):
        ear = Pos(-trail, side * (wide - cheek) / 2, wheel) * (Box(16, cheek, arm_low - 2 - wheel, align=UP) + along_y(8, cheek))
        body += ear
    return body + Pos(-trail, 0, wheel) * along_y(axle / 2, wide)


def wheel(wheel, tread, axle, play):
    tyre = along_y(wheel, tread)
    return chamfer(tyre.edges(), 1) - along_y(axle / 2 + play, 2 * tread)
