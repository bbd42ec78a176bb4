"""Foot and post about z, all others about the arm's axis, x."""

from build123d import Align, Box, Cylinder, Pos, Rot

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def along_x(radius, low, high):
    return Pos(X=(low + high) / 2) * Rot(0, 90, 0) * Cylinder(radius, high - low)


def foot(wide, high, seat):
    return Cylinder(wide / 2, high, align=UP) - Pos(Z=5) * Cylinder(seat / 2, high, align=UP)


def post(pivot, foot, seat, slot):
    body = Pos(Z=5) * Cylinder(seat / 2, foot, align=UP) + Pos(Z=foot) * Cylinder(15, pivot - 60 - foot, align=UP)
    body += Pos(Z=pivot - 60) * Box(36, 40, 75, align=UP)
    return body - Pos(Z=pivot - 34) * Box(60, slot, 80, align=UP)


def arm(rod, hub, front, tail):
    return along_x(rod / 2, -tail, front) + Rot(90, 0, 0) * Cylinder(13, hub)


def head(wide, high, rod, end):
    return Cylinder(wide / 2, high) - along_x(rod / 2, -wide, -end)


def weight(wide, long, rod):
    return along_x(wide / 2, -long / 2, long / 2) - along_x(rod / 2, -long, long)
