from math import cos, radians, sin

from build123d import Align, Box, Circle, Cylinder, Polygon, Pos, Rot, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)
ACROSS = Rot(90, 0, 0)


def block(long, wide, top, low, foot, wall, pitch, across, play, journal):
    body = Pos(0, 0, top) * Box(wide, long, top - low, align=DOWN)
    for y in (-1, 1):
        body += Pos(0, y * (long - wall) / 2, -foot) * Box(wide, wall, foot + low, align=UP)
    for y in (-pitch, 0, pitch):
        body -= Pos(0, y, 0) * Cylinder(across / 2 + play, 2 * top, align=UP)
    return body - ACROSS * Cylinder(journal / 2 + play, 2 * long)


def crank(throw, pitch, rod_thick, side, web, disc, journal, throw_pin, shaft_long):
    """Pins at 0, 120 and 240 degrees from x about y, from -y on."""
    shaft = ACROSS * Cylinder(journal / 2, shaft_long)
    for k in (0, 1, 2):
        y, gap = (k - 1) * pitch, rod_thick + 2 * side
        pin = Pos(throw * cos(radians(-120 * k)), y, throw * sin(radians(-120 * k)))
        shaft += Pos(0, y, 0) * ACROSS * Cylinder(disc, gap + 2 * web)
        shaft -= Pos(0, y, 0) * ACROSS * Cylinder(disc + 1, gap)
        shaft += pin * ACROSS * Cylinder(throw_pin / 2, gap + web)
    return shaft


def rod(rod, big, small, rod_thick, throw_pin, pin, play):
    flat = Circle(big) + Pos(0, rod) * Circle(small)
    flat += Polygon((-8, 0), (8, 0), (6, rod), (-6, rod), align=None)
    flat -= Circle(throw_pin / 2 + play) + Pos(0, rod) * Circle(pin / 2 + play)
    return ACROSS * extrude(flat, rod_thick / 2, both=True)


def piston(across, crown, skirt, small, rod_thick, side, pin):
    """Gudgeon pin along y through the origin, fast in the piston."""
    body = Pos(0, 0, -skirt) * Cylinder(across / 2, crown + skirt, align=UP)
    body -= Pos(0, 0, small + 0.8) * Box(2 * across, rod_thick + 2 * side, 3 * across, align=DOWN)
    return body + ACROSS * Cylinder(pin / 2, across - 6)
