from math import cos, radians, tan

from build123d import Align, Box, Cone, Cylinder, Plane, Pos, Rectangle, Rot, Sphere, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)
CORNER = (Align.MIN, Align.MIN)


def frame(back, arm, long, tall, wide, screw_x, screw_d, play):
    shape = Rectangle(long, tall, align=CORNER) - Pos(back, arm) * Rectangle(long, tall - 2 * arm, align=CORNER)
    body = extrude(Plane.XZ * shape, wide / 2, both=True)
    return body - Pos(screw_x, 0, tall) * Cylinder(screw_d / 2 + play, 3 * arm)


def screw(ball_z, ball_d, neck_d, screw_d, top, head_d, head, bar_d, bar_z, neck=18, free=0.2):
    """Ball at the origin, neck, shank, head with the bar's bore along y."""
    high = top - ball_z
    body = Sphere(ball_d / 2) + Cylinder(neck_d / 2, neck + 1, align=UP)
    body += Pos(Z=neck) * Cylinder(screw_d / 2, high - neck - 1, align=UP)
    body += Pos(Z=high - head) * Cylinder(head_d / 2, head, align=UP)
    return body - Pos(Z=bar_z - ball_z) * Rot(X=90) * Cylinder(bar_d / 2 + free, 2 * head_d)


def pad(ball_d, neck_d, tilt_deg, across=26, below=6.5, above=6.5, gap=0.2):
    disc = Pos(Z=-below) * Cylinder(across / 2, below + above, align=UP)
    low, slope = neck_d / 2 / cos(radians(tilt_deg)) + gap, tan(radians(tilt_deg + 1))
    return disc - Sphere(ball_d / 2 + gap) - Cone(low, low + slope * 2 * above, 2 * above, align=UP)


def bar(bar_d, long=116, knob_d=14, knob=11):
    """About z, with a knob at each end."""
    rod = Cylinder(bar_d / 2, long)
    for side in (-1, 1):
        rod += Pos(Z=side * (long - knob) / 2) * Cylinder(knob_d / 2, knob)
    return rod
