"""Boards of the rack; a side stands at x = 0 of its frame, rails about x = 0."""

from build123d import Align, Box, Polygon, Pos, Rot, extrude

LOW = (Align.MIN, Align.MIN, Align.MIN)


def side(deep, high, side, rail_deep, rail_high, sunk, first, pitch):
    body = Box(side, deep, high, align=LOW)
    for level in range(3):
        for y in (0, deep - rail_deep):
            body -= Pos(side - sunk, y, first + level * pitch) * Box(side, rail_deep, rail_high, align=LOW)
    return body


def front_rail(long, rail_deep, rail_high):
    return Box(long, rail_deep, rail_high, align=(Align.CENTER, Align.MIN, Align.MIN))


def brace(wide, slat, low, high, band):
    """A slat that leans from one side to the other, its ends upright."""
    outline = [(-wide / 2, low), (wide / 2, high), (wide / 2, high + band), (-wide / 2, low + band)]
    return extrude(Rot(90, 0, 0) * Polygon(*outline, align=None), -slat)
