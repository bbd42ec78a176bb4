"""Parts of the bicycle rack; bolt, nut and clamp are drawn for a post at the front (-y), about the bolt's axis."""

from build123d import Align, Axis, Box, Cylinder, Pos, Rot, chamfer

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def along_x(diameter, start, end):
    return Pos((start + end) / 2, 0, 0) * Rot(0, 90, 0) * Cylinder(diameter / 2, end - start)


def rail(long, rail_wide, rail_high, wall, pitch, screw_d):
    """Tube with a hole for each tray's screw in its upper wall."""
    body = Box(long, rail_wide, rail_high, align=UP)
    body -= Pos(0, 0, wall) * Box(2 * long, rail_wide - 2 * wall, rail_high - 2 * wall, align=UP)
    for i in range(10):
        body -= Pos((i - 4.5) * pitch, 0, rail_high) * Cylinder(screw_d / 2, 4 * wall)
    return body


def tray(tray_long, tray_wide, tray_high, tray_wall, rail_apart, screw_d):
    body = Box(tray_wide, tray_long, tray_high, align=UP)
    body -= Pos(0, 0, tray_wall) * Box(tray_wide - 2 * tray_wall, 2 * tray_long, tray_high, align=UP)
    for side in (-1, 1):
        body -= Pos(0, side * rail_apart / 2, 0) * Cylinder(screw_d / 2, 4 * tray_wall)
    return body


def screw(screw_head, screw_d, screw_long, head=4):
    """Its head lies on z = 0."""
    return Cylinder(screw_head / 2, head, align=UP) + Pos(0, 0, head - screw_long) * Cylinder(screw_d / 2, screw_long, align=UP)


def post(high, post, wall, bolt_down, bolt_d):
    """Tube, closed by a plate above."""
    body = Box(post, post, high, align=UP) - Pos(0, 0, -wall) * Box(post - 2 * wall, post - 2 * wall, high, align=UP)
    return body - Pos(0, 0, high - bolt_down) * along_x(bolt_d, -post, post)


def bolt(bolt_d, bolt_long, head_d, head_high, clamp_wide, air):
    """From its round head at -x."""
    start = -clamp_wide / 2 - air
    head = along_x(head_d, start - head_high, start)
    return head + along_x(bolt_d, start - 1, start - head_high + bolt_long)


def nut(bolt_d, head_d, nut_high, clamp_wide, air):
    start = clamp_wide / 2 + air
    return along_x(head_d, start, start + nut_high) - along_x(bolt_d, 0, 2 * clamp_wide)


def clamp(clamp_wide, clamp_long, bar_off, arm_high, bolt_d, play, post, stem_d, stem_in, side_air=1):
    """Two arms from the bolt toward +y, joined by a bar."""
    mouth = post + 2 * side_air
    body = along_x(arm_high, -clamp_wide / 2, clamp_wide / 2)
    body += Pos(0, (clamp_long - arm_high / 2) / 2, 0) * Box(clamp_wide, clamp_long - arm_high / 2, arm_high)
    low = bar_off - arm_high / 2
    body -= Pos(0, low / 2 - arm_high, 0) * Box(mouth, low + 2 * arm_high, 2 * arm_high)
    body -= along_x(bolt_d + play, -clamp_wide, clamp_wide)
    return body - Pos(0, bar_off, arm_high / 2) * Cylinder(stem_d / 2, 2 * stem_in)


def knob(knob_d, stem_d, stem_in, knob_high, head=21):
    """Its stem enters the bar at z = 0."""
    out = knob_high - stem_in
    grip = Pos(0, 0, out - head) * Cylinder(knob_d / 2, head, align=UP)
    grip = chamfer(grip.edges().group_by(Axis.Z)[-1], 3)
    return grip + Pos(0, 0, -stem_in) * Cylinder(stem_d / 2, knob_high - head + 1, align=UP)
