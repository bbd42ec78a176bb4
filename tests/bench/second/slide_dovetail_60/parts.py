from math import hypot

from build123d import Align, Box, Cylinder, Plane, Polygon, Pos, Rot, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def tongue(neck, crown, tail, long, wider, higher):
    """The dovetail along x, wider by so much on each flank and higher by so much above."""
    slope = (crown - neck) / 2 / tail
    low, high = neck / 2 - slope * 2 + wider, crown / 2 + slope * higher + wider
    shape = Polygon((-low, -2), (low, -2), (high, tail + higher), (-high, tail + higher), align=None)
    return extrude(Plane.YZ * shape, long / 2, both=True)


def base(long, tail, neck, crown, sole, sole_wide):
    body = Pos(Z=-sole) * Box(long, sole_wide, sole, align=UP)
    clear = Box(2 * long, 2 * crown, 2 * tail, align=UP)
    return body + (tongue(neck, crown, tail, long, 0, 0) & clear)


def saddle(saddle_long, saddle_wide, saddle_high, tail, neck, crown, play, under, roof, screw_d, screw_play, screw_z):
    """Block from z = 0, which lies a little above the base; its groove is drawn from the dovetail."""
    slope = (crown - neck) / 2 / tail
    body = Box(saddle_long, saddle_wide, saddle_high, align=UP)
    body -= Pos(Z=-under) * tongue(neck, crown, tail, 2 * saddle_long, play * hypot(1, slope), roof)
    return body - Pos(0, saddle_wide / 2, screw_z - under) * Rot(X=90) * Cylinder(screw_d / 2 + screw_play, saddle_wide)


def thumb_screw(screw_d, head_d, saddle_wide, tip_y, loose, head=9, free=0.5):
    shank = saddle_wide / 2 + loose + free - tip_y
    return Cylinder(screw_d / 2, shank + 1, align=UP) + Pos(Z=shank) * Cylinder(head_d / 2, head, align=UP)
