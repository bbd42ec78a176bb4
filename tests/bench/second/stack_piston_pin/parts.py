"""Turned about the pin's axis, along x."""

from build123d import Align, Box, Cylinder, Pos, Rot

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def across(radius, long):
    return Rot(0, 90, 0) * Cylinder(radius, long)


def rod(small_end, hole, centres):
    big = Pos(Z=-centres)
    body = across(11, small_end) + big * across(17, 20)
    body += Pos(Z=-centres / 2) * Box(8, 12, centres - 20)
    return body - across(hole / 2, 2 * small_end) - big * across(11, 40)


def piston(bore, between, rings, seat):
    body = Pos(Z=-18) * Cylinder(bore / 2, 45, align=UP)
    hollow = Pos(Z=-18) * Cylinder(bore / 2 - 4, 37, align=UP)
    bosses = across(12, bore) + Box(bore, 16, 20, align=UP)
    hollow -= bosses - Box(between, bore, bore)
    body -= hollow
    for z in (14.5, 20.5):
        body -= Pos(Z=z) * (Cylinder(bore, 2) - Cylinder(bore / 2 - 1.5, 2))
    body -= across(7.01, 2 * bore)
    for side in (-1, 1):
        body -= Pos(X=side * (rings / 2 + 10)) * across(seat / 2, 20)
    return body


def gudgeon_pin(outer, inner, long):
    return across(outer / 2, long) - across(inner / 2, long)


def ring(ring, outer):
    return Pos(X=ring / 2) * (across(outer / 2, ring) - across(5.5, ring))
