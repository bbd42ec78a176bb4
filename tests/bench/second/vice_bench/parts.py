from build123d import Align, Box, Cylinder, Pos, Rot

UP = (Align.CENTER, Align.CENTER, Align.MIN)
LOW = (Align.MIN, Align.MIN, Align.MIN)
Y = Rot(X=-90)  # turns z to y


def block(x, y, z):
    """Return a box between two values of each coordinate."""
    return Pos(x[0], y[0], z[0]) * Box(x[1] - x[0], y[1] - y[0], z[1] - z[0], align=LOW)


def rod(across, y, long, z=0):
    return Pos(0, y, z) * Y * Cylinder(across / 2, long, align=UP)


def body(wide, body_deep, top, beam, beam_z, play, spindle_d, spindle_z, spindle_play, sole=16, sole_wide=150):
    """Fixed jaw on a sole with four bolt holes."""
    shape = block((-wide / 2, wide / 2), (0, body_deep), (0, top)) + block((-sole_wide / 2, sole_wide / 2), (0, body_deep + 20), (0, sole))
    half = beam / 2 + play
    shape -= block((-half, half), (-1, body_deep + 30), (beam_z - half, beam_z + half))
    shape -= rod(spindle_d + 2 * spindle_play, -1, body_deep + 30, spindle_z)
    for x in (15 - sole_wide / 2, sole_wide / 2 - 15):
        for y in (15, body_deep + 5):
            shape -= Pos(x, y, 0) * Cylinder(5.5, 4 * sole)
    return shape


def jaw(wide, jaw_deep, top, beam, beam_z, beam_end, shut, spindle_d, spindle_z, spindle_play, collar_d, collar, low=16):
    """Jaw before y = 0 with the beam behind it; a recess behind takes the collar."""
    shape = block((-wide / 2, wide / 2), (-jaw_deep, 0), (low, top)) + block((-beam / 2, beam / 2), (-1, beam_end + shut), (beam_z - beam / 2, beam_z + beam / 2))
    shape -= rod(spindle_d + 2 * spindle_play, -2 * jaw_deep, 4 * jaw_deep, spindle_z) - rod(collar_d + 40, 1, 4 * jaw_deep, spindle_z)
    return shape - rod(collar_d + 1, -collar - 1.5, 2 * collar, spindle_z)


def spindle(spindle_d, spindle_end, jaw_deep, shut, head_d, head, head_gap, bar_d, bar_play):
    """Along y; y = 0 is the jaw's front face."""
    shape = rod(spindle_d, -head_gap - 1, spindle_end + shut + jaw_deep + head_gap + 1) + rod(head_d, -head_gap - head, head)
    return shape - Pos(0, -head_gap - head / 2, 0) * Rot(Y=90) * Cylinder(bar_d / 2 + bar_play, 2 * head_d)


def collar(spindle_d, collar_d, collar):
    return rod(collar_d, 0, collar) - rod(spindle_d, -collar, 3 * collar)


def tommy(bar_d, long=150, knob_d=16, knob=13):
    bar = Cylinder(bar_d / 2, long)
    for side in (-1, 1):
        bar += Pos(0, 0, side * (long - knob) / 2) * Cylinder(knob_d / 2, knob)
    return Rot(Y=90) * bar
