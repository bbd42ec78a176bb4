from build123d import Align, Box, Cylinder, Pos, Rot

UP = (Align.CENTER, Align.CENTER, Align.MIN)
X = Rot(Y=90)


def foot(column_d, column_low, column_top, spindle_d, play, leg_r, pad_r, pad, clamp_z, clamp_d, clamp_play, leg_low=44, leg_high=40, leg_wide=36, post_d=25):
    body = Pos(Z=column_low) * Cylinder(column_d / 2, column_top - column_low, align=UP)
    for turn in (180, 60, -60):
        leg = Pos(Z=leg_low) * Box(leg_r, leg_wide, leg_high, align=(Align.MIN, Align.CENTER, Align.MIN))
        body += Rot(Z=turn) * (leg + Pos(pad_r, 0, pad) * Cylinder(post_d / 2, leg_low + 1 - pad, align=UP))
    body -= Pos(Z=leg_low + leg_high) * Cylinder(spindle_d / 2 + play, column_top, align=UP)
    return body - Pos(0, 0, clamp_z) * X * Cylinder(clamp_d / 2 + clamp_play, column_d, align=UP)


def seat(seat_d, seat_low, seat_top, spindle_d, spindle_low):
    disc = Cylinder(seat_d / 2, seat_top - seat_low, align=UP)
    return disc + Pos(Z=spindle_low - seat_low) * Cylinder(spindle_d / 2, seat_low - spindle_low + 1, align=UP)


def clamp(clamp_d, tip_x, column_d, knob_d=27, knob=12, free=4):
    """From its tip along x, with a knob."""
    start = column_d / 2 + free - tip_x
    return X * Cylinder(clamp_d / 2, start + 1, align=UP) + Pos(start, 0, 0) * X * Cylinder(knob_d / 2, knob, align=UP)


def pad(pad_d, pad):
    return Cylinder(pad_d / 2, pad, align=UP)
