from math import cos, radians, tan

from build123d import Align, Box, Cone, Cylinder, Pos, Rot, Sphere

UP = (Align.CENTER, Align.CENTER, Align.MIN)
LOW = (Align.MIN, Align.MIN, Align.MIN)
Y = Rot(X=90)


def block(x, y, z):
    """Return a box between two values of each coordinate."""
    return Pos(x[0], y[0], z[0]) * Box(x[1] - x[0], y[1] - y[0], z[1] - z[0], align=LOW)


def base(side, high, stick_y, ball_z, ball_d, ball_gap, mount_d, mount_top, neck_d, tilt_deg, throttle_y, slot_long, slot, slot_play, ledge, foot_wide, foot):
    """Block with a socket that reaches over the ball, and a slot that is wider below."""
    body = Box(side, side, high, align=UP) + Pos(0, stick_y, 0) * Cylinder(mount_d / 2, mount_top, align=UP)
    near, slope, up = neck_d / 2 / cos(radians(tilt_deg)) + ball_gap, tan(radians(tilt_deg)), ball_d
    body -= Pos(0, stick_y, ball_z) * (Sphere(ball_d / 2 + ball_gap) + Cone(near, near + slope * up, up, align=UP))
    body -= Pos(0, throttle_y, ledge - 2) * Box(slot_long, slot + 2 * slot_play, high, align=UP)
    return body - Pos(0, throttle_y, ledge - foot - 2 * slot_play) * Box(slot_long, foot_wide + 2 * slot_play, foot + 2 * slot_play, align=UP)


def stick(ball_d, ball_z, neck_d, grip_d, grip_low, grip_top, button_d, button_play, flange_d, flange, flange_z, press, pivot_x, pivot_z, pin_d, trigger, neck_top=82, shank_d=18, lug=4):
    """About the ball's middle."""
    body = Sphere(ball_d / 2) + Cylinder(neck_d / 2, neck_top - ball_z + 1, align=UP)
    body += Pos(Z=neck_top - ball_z) * Cylinder(shank_d / 2, grip_low - neck_top + 1, align=UP)
    body += Pos(Z=grip_low - ball_z) * Cylinder(grip_d / 2, grip_top - grip_low, align=UP)
    near, z = trigger / 2 + 0.5, pivot_z - ball_z
    for y in ((-near - lug, -near), (near, near + lug)):
        body += block((grip_d / 2 - 4, pivot_x + 5.5), y, (z - 6, z + 6))
    body += Pos(pivot_x, 0, z) * Y * Cylinder(pin_d / 2, 2 * near + 2)
    body -= Pos(Z=flange_z - ball_z - press - 0.3) * Cylinder(flange_d / 2 + button_play, flange + press + 0.5, align=UP)
    return body - Pos(Z=flange_z - ball_z) * Cylinder(button_d / 2 + button_play, grip_top, align=UP)


def trigger(trigger, pin_d, pin_play, thick=8, down=35):
    """About its pin, the blade below."""
    body = Y * Cylinder(5.5, trigger) + block((-thick / 2, thick / 2), (-trigger / 2, trigger / 2), (-down, 0))
    return body - Y * Cylinder(pin_d / 2 + pin_play, 3 * trigger)


def button(button_d, flange_d, flange, flange_z, top):
    return Cylinder(flange_d / 2, flange, align=UP) + Cylinder(button_d / 2, top - flange_z, align=UP)


def throttle(high, slot, ledge, foot_wide, foot, blade, slot_play, knob_low=65, knob_top=85):
    """Blade through the slot of the base, whose upper face is z = 0; a foot below, a knob above."""
    low = ledge - high - slot_play
    body = Pos(Z=low - foot) * Box(blade, foot_wide, foot, align=UP) + Pos(Z=low - 1) * Box(blade, slot, knob_low - ledge + 2, align=UP)
    return body + Pos(Z=knob_low - high) * Box(24, 50, knob_top - knob_low, align=UP)
