from math import cos, radians, sin

from build123d import Align, Axis, Box, Cylinder, Pos, Rot, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)
FRONT, ALONG_X = Rot(90, 0, 0), Rot(0, 90, 0)  # z to -y, z to x


def foot(foot, foot_high, post, post_top, neck, neck_top, button, button_y, button_apart, press, under, play):
    body = fillet(Cylinder(foot / 2, foot_high, align=UP).edges().sort_by(Axis.Z)[-1], 4)
    body += Cylinder(post / 2, post_top, align=UP) + Cylinder(neck / 2, neck_top, align=UP)
    for x in (-button_apart, 0, button_apart):
        body -= Pos(x, button_y, foot_high - under - press - 1) * Cylinder(button / 2 + play, foot_high, align=UP)
    return body


def button(button, proud, under):
    return fillet((Pos(0, 0, -under) * Cylinder(button / 2, proud + under, align=UP)).edges().sort_by(Axis.Z)[-1], 1.5)


def head(post_top, neck, neck_top, head, head_top, tip_z, ear, gap, pin, play):
    """A cap on the neck of the post with two ears for the housing's pins."""
    high = tip_z - post_top
    body = Cylinder(head / 2, head_top - post_top, align=UP)
    for x in (-1, 1):
        ear_x = Pos(x * (gap / 2 + play + 4), 0, 0)
        body += ear_x * Box(8, ear, high, align=UP) + ear_x * Pos(0, 0, high) * ALONG_X * Cylinder(ear / 2, 8)
    body -= Pos(0, 0, high) * ALONG_X * Cylinder(pin / 2 + play, 2 * head)
    return body - Cylinder(neck / 2 + play, neck_top - post_top + 1, align=UP)


def housing(tip_z, axis_z, motor, front_y, rear_y, shaft, shaft_end, gap, pin):
    """Motor housing over a stem with pins along x through the origin."""
    up, long = axis_z - tip_z, rear_y - front_y
    motor_body = Pos(0, rear_y, up) * FRONT * Cylinder(motor / 2, long, align=UP)
    body = fillet(motor_body.edges().sort_by(Axis.Y)[-1], 6)
    body += Pos(0, front_y + 1, up) * FRONT * Cylinder(shaft / 2, front_y - shaft_end + 1, align=UP)
    body += Box(gap, 15, up, align=UP) + ALONG_X * Cylinder(7.5, gap)
    return body + ALONG_X * Cylinder(pin / 2, gap + 14)


def guard(guard, front_y, guard_front, motor, shaft, wall=4.5, spoke=6):
    deep = front_y - guard_front
    body = FRONT * (Cylinder(guard / 2, deep, align=UP) - Cylinder(guard / 2 - wall, 3 * deep))
    for turn in (45, 135):
        body += FRONT * Rot(0, 0, turn) * Box(guard - wall, 10, spoke, align=UP)
    body += FRONT * Cylinder(motor / 2, spoke, align=UP)
    return body - FRONT * Cylinder(shaft / 2 + 1, 3 * deep)


def rotor(rotor, rotor_deep, shaft, play, hub=36, thick=3, pitch_deg=27):
    """Four blades; -y is the front."""
    wide = (rotor_deep - thick * cos(radians(pitch_deg))) / sin(radians(pitch_deg))
    body = Cylinder(hub / 2, rotor_deep)
    for turn in (0, 90, 180, 270):
        body += Rot(0, 0, turn) * Pos(rotor / 4, 0, 0) * Rot(pitch_deg, 0, 0) * Box(rotor / 2, wide, thick)
    return FRONT * (body - Cylinder(shaft / 2 + play, 3 * rotor_deep))
