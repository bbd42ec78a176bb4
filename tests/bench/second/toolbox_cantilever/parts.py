from math import cos, radians, sin

from build123d import Align, Axis, Box, Circle, Cylinder, Plane, Pos, Rot, extrude, fillet, make_hull

FRONT = Rot(X=90)  # turns z to -y
UP = (Align.CENTER, Align.CENTER, Align.MIN)


def _box(wide, deep, high, sheet, align_x):
    body = Box(wide, deep, high, align=(align_x, Align.MIN, Align.MIN))
    body = fillet(body.edges().filter_by(Axis.Z), 3)
    shift = {Align.CENTER: 0, Align.MAX: -sheet}[align_x]
    room = Pos(shift, sheet, sheet) * Box(wide - 2 * sheet, deep - 2 * sheet, high, align=(align_x, Align.MIN, Align.MIN))
    return body - fillet(room.edges().filter_by(Axis.Z), 1.5)


def _rivet(x, z, arm_thick, air, pin_d, head_d, head):
    end = air + arm_thick + air
    pin = Cylinder(pin_d / 2, end + 0.1, align=UP) + Pos(0, 0, end) * Cylinder(head_d / 2, head, align=UP)
    return Pos(x, 0, z) * FRONT * pin


def base(deep, base_wide, base_high, sheet, base_x, base_z, short_off, arm_thick, air, pin_d, head_d, head):
    body = _box(base_wide, deep, base_high, sheet, Align.CENTER)
    for x in (base_x, base_x + short_off, -base_x, -base_x - short_off):
        body += _rivet(x, base_z, arm_thick, air, pin_d, head_d, head)
    return body


def lower_tray(tray_wide, tray_deep, tray_high, sheet, base_x, step_x, short_off, upper_off, lower_x, pin_up, arm_thick, air, pin_d, head_d, head):
    """Its inner lower front edge is the origin, the tray lies towards -x."""
    body = _box(tray_wide, tray_deep, tray_high, sheet, Align.MAX)
    for off in (0, short_off, -upper_off):
        body += _rivet(base_x + step_x - lower_x + off, pin_up, arm_thick, air, pin_d, head_d, head)
    return body


def upper_tray(tray_wide, tray_deep, tray_high, sheet, base_x, step_x, upper_off, upper_x, pin_up, arm_thick, air, pin_d, head_d, head):
    body = _box(tray_wide, tray_deep, tray_high, sheet, Align.MAX)
    for off in (0, -upper_off):
        body += _rivet(base_x + 2 * step_x - upper_x + off, pin_up, arm_thick, air, pin_d, head_d, head)
    return body


def long_arm(reach, middle, rest_deg, arm_thick, air, pin_d, play, eye=6):
    """A flat bar from the pin at the origin, leaning as drawn."""
    along = cos(radians(rest_deg)), sin(radians(rest_deg))
    figure = make_hull([*Circle(eye).edges(), *(Pos(reach * along[0], reach * along[1]) * Circle(eye)).edges()])
    for at in sorted({0, middle, reach}):
        figure -= Pos(at * along[0], at * along[1]) * Circle(pin_d / 2 + play)
    return Pos(0, -air, 0) * extrude(Plane.XZ * figure, arm_thick)


short_arm = upper_arm = long_arm
