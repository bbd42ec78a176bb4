"""Plates lie on z = 0 of their frames; studs, bushes and nuts stand on their axes."""

from build123d import Align, Box, Circle, Cylinder, Pos, RegularPolygon, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def bored(long, wide, thick, stud_x, stud_y, hole, bottom=-1):
    """Return a plate with four round holes that begin at a height."""
    body = Box(long, wide, thick, align=UP)
    for x in (-stud_x, stud_x):
        for y in (-stud_y, stud_y):
            body -= Pos(x, y, bottom) * Cylinder(hole / 2, thick + 2, align=UP)
    return body


def base(long, wide, stud_x, stud_y, seat):
    high = seat + 6
    return Pos(Z=-high) * bored(long + 30, wide + 30, high, stud_x, stud_y, 8, 6)


def gasket(long, wide, thick, stud_x, stud_y):
    return bored(long, wide, thick, stud_x, stud_y, 13)


plate = gasket


def cover(long, wide, lid, stud_x, stud_y):
    return bored(long, wide, lid, stud_x, stud_y, 8.4)


def stud(seat, high):
    return Pos(Z=-seat) * Cylinder(4, high + seat, align=UP)


def bush(bush):
    return Cylinder(6, bush, align=UP) - Cylinder(4.1, bush, align=UP)


def nut(size):
    return extrude(RegularPolygon(size / 2, 6, major_radius=False) - Circle(4.1), 6.8)
