"""The tread on z = 0 of its frame; yokes and legs about the axis of the pin, along y."""

from build123d import Align, Box, Cylinder, Pos, Rot

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def tread(long, deep, tread):
    return Box(long, deep, tread, align=UP)


def yoke(yoke_deep, gap, web, inside, outside):
    cheeks = 2 * inside + 10
    body = Pos(X=-outside) * Box(outside + cheeks / 2, yoke_deep, web, align=(Align.MIN, Align.CENTER, Align.MAX))
    return body - Pos(X=-inside) * Box(2 * cheeks, gap, web, align=(Align.MIN, Align.CENTER, Align.MAX))


def leg(leg, leg_wide, long):
    return Rot(90, 0, 0) * Cylinder(leg / 2, leg_wide) + Box(leg, leg_wide, long, align=DOWN)
