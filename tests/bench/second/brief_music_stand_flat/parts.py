"""Sticks and boards; strut and lug about the axes of their pins, along x."""

from build123d import Align, Box, Cylinder, Pos, Rot

UP = (Align.CENTER, Align.MIN, Align.MIN)
DOWN = (Align.CENTER, Align.MAX, Align.MAX)


def across(radius, long):
    return Rot(0, 90, 0) * Cylinder(radius, long)


def post(high, post, deep):
    return Box(post, deep, high - deep / 2, align=UP) + Pos(Y=deep / 2, Z=high - deep / 2) * across(deep / 2, post)


def foot(wide, front, deep, foot, slot):
    body = Pos(Y=-front) * Box(wide, front + deep, foot, align=UP)
    return body - Box(slot, deep, foot, align=UP)


def strut(strut, deep, long):
    low = Pos(Z=-long)
    return across(deep / 2, strut) + low * across(deep / 2, strut) + low * Box(strut, deep, long, align=(Align.CENTER, Align.CENTER, Align.MIN))


def panel(wide, tall, panel):
    return Box(wide, panel, tall, align=DOWN)


def ledge(wide, panel):
    return Box(wide, 26, panel, align=(Align.CENTER, Align.MAX, Align.MIN))


def lug(lug, deep, air):
    body = Pos(Y=-air - deep / 2) * Box(lug, air + deep / 2, deep + 12, align=(Align.CENTER, Align.MIN, Align.CENTER)) + across(deep / 2, lug)
    return body - across(4.15, 2 * lug)
