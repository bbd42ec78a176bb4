from math import cos, radians, tan

from build123d import Align, Axis, Box, Circle, Cone, Cylinder, Plane, Pos, Rot, Sphere, chamfer, extrude, fillet, make_hull

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def _bar(thick, y, *circles):
    """A plate round circles (x, z, radius), its middle at y."""
    figure = make_hull([edge for x, z, r in circles for edge in (Pos(x, z) * Circle(r)).edges()])
    body = extrude(Plane.XZ * figure, thick / 2, both=True)
    return Pos(0, y, 0) * chamfer(body.faces().filter_by(Axis.Y).edges(), 0.5)


def base(base_d, base_high, recess, journal_d, play, knob_x, knob_d):
    body = Cylinder(base_d / 2, base_high, align=UP)
    body = fillet(body.edges().sort_by(Axis.Z)[-1], 6)
    body = chamfer(body.edges().sort_by(Axis.Z)[0], 1)
    body -= Cylinder(journal_d / 2 + play, 4 * base_high) + Cylinder(16, recess, align=UP)
    return body - Pos(knob_x, 0, base_high) * Cylinder(knob_d / 2 + play, 14, align=DOWN)


def retainer(across=26, thick=4):
    disc = Pos(0, 0, -0.2) * Cylinder(across / 2, thick, align=DOWN)
    return chamfer(disc.edges(), 0.5)


def column(part, base_high, recess, journal_d, shoulder_z, bar, half, gap, cheek, across=18, flange=34):
    """A journal below z = 0, a flange on the base, and a fork at the top."""
    tall = shoulder_z - base_high
    wide = bar + 2 * gap + 2 * cheek
    body = Pos(0, 0, recess - 0.2 - base_high) * Cylinder(journal_d / 2, base_high - recess + 1, align=UP)
    foot = Pos(0, 0, 0.2) * Cylinder(flange / 2, 6, align=UP)
    body += chamfer(foot.edges().sort_by(Axis.Z)[-1], 1)
    body += Pos(0, 0, 0.2) * Cylinder(across / 2, tall - 20, align=UP)
    body += Pos(0, 0, tall - 26) * Box(2 * half, wide, 12, align=UP)
    for side in (-1, 1):
        body += _bar(cheek, side * (bar / 2 + gap + cheek / 2), (0, tall, half), (0, tall - 17, half))
    return part.made(body)


def lower_arm(part, shoulder_z, elbow_z, bar, half, gap, cheek):
    long = elbow_z - shoulder_z
    body = _bar(bar, 0, (0, 0, half), (0, long - 26, half))
    for side in (-1, 1):
        body += _bar(cheek + gap, side * (bar / 2 + gap / 2 + cheek / 2), (0, long - 42, half), (0, long - 26, half))
        body += _bar(cheek, side * (bar / 2 + gap + cheek / 2), (0, long - 42, half), (0, long, half))
    return part.made(body)


def upper_arm(part, reach, lift, neck, neck_d, ball_d, bar, half):
    body = _bar(bar, 0, (0, 0, half), (reach, lift, 7.5))
    body += Pos(reach, 0, lift - neck) * Cylinder(neck_d / 2, neck, align=UP)
    return part.made(body + Pos(reach, 0, lift - neck) * Sphere(ball_d / 2))


def shade(ball_d, neck_d, cone_deg, top_r=15, lip=8, wide_r=58, tall=78, sheet=1.6, gap=0.2):
    """A cone open downwards, with a socket about the origin."""
    low = -tall
    shell = Pos(0, 0, low) * Cone(wide_r, top_r, tall - 2, align=UP) - Pos(0, 0, low - 0.01) * Cone(wide_r - sheet, top_r - sheet, tall - 2 - sheet, align=UP)
    shell += Pos(0, 0, lip) * Cylinder(top_r, lip + 14, align=DOWN)
    shell -= Sphere(ball_d / 2 + gap)
    slope, start = tan(radians(cone_deg + 1)), neck_d / 2 / cos(radians(cone_deg)) + gap
    return shell - Cone(start, start + 20 * slope, 20, align=UP)


def dimmer(knob_d, across=22, tall=13):
    cap = Pos(0, 0, 0.2) * Cylinder(across / 2, tall, align=UP)
    cap = fillet(cap.edges().sort_by(Axis.Z)[-1], 1.5)
    cap -= Pos(0, across / 2, tall) * Box(1.5, across / 2, 2)
    return cap + Pos(0, 0, 1) * Cylinder(knob_d / 2, 13, align=DOWN)
