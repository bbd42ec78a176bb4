from build123d import Align, Axis, Box, Cylinder, Pos, Rot, chamfer, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)
FORWARD = (Align.MIN, Align.CENTER, Align.MIN)
ACROSS = Rot(90, 0, 0)


def base(long, wide, plate, pin_x, pin_z, pin, ear, ears, ear_top):
    body = Box(long, wide, plate, align=UP)
    body = fillet(body.edges().filter_by(Axis.Z), 1.5)
    for y in (-1, 1):
        body += Pos(pin_x, y * (ears + ear) / 2, plate - 1) * Box(16, ear, ear_top - plate + 1, align=UP)
    body += Pos(62, 0, plate) * Box(20, 12, 1, align=UP)
    return body + Pos(pin_x, 0, pin_z) * ACROSS * Cylinder(pin / 2, ears + ear)


def magazine(pin, play, eye, knuckle, front, trough_wide, trough_low, trough, channel, sole, head):
    """An eye on the pin, a neck and a trough that is open above and shut at the mouth."""
    body = ACROSS * Cylinder(knuckle, eye) + Pos(0, 0, -5) * Box(14, eye - 3, 7, align=FORWARD)
    body += Pos(12, 0, -trough_low) * Box(front - 12, trough_wide, trough, align=FORWARD)
    body -= Pos(15, 0, sole - trough_low) * Box(front - 15 - head, channel, trough, align=FORWARD)
    return body - ACROSS * Cylinder(pin / 2 + play, 2 * trough_wide)


def top(long, pin_x, pin, play, arm_wide, arm_low, arm_high, cheek):
    """A bar over the magazine with a cheek on each side of its eye."""
    bar = Pos(-8, 0, arm_low) * Box(long / 2 - pin_x + 8, arm_wide, arm_high, align=FORWARD)
    body = chamfer(bar.edges().filter_by(Axis.X), 1)
    for y in (-1, 1):
        side = Pos(0, y * (arm_wide - cheek) / 2, 0)
        body += side * ACROSS * Cylinder(8, cheek) + side * Pos(0, 0, arm_low + 2) * Box(16, cheek, arm_low + 2, align=DOWN)
    return body - ACROSS * Cylinder(pin / 2 + play, 2 * arm_wide)


def pusher(channel, slide, pusher, trough, sole):
    """On the channel's floor; its upper edges are broken."""
    body = Box(pusher, channel - 2 * slide, trough - sole - 1, align=UP)
    return chamfer(body.edges().filter_by(Axis.X).group_by(Axis.Z)[-1], 1)
