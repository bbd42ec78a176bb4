from build123d import Align, Box, Cylinder, Pos

LOW = (Align.MIN, Align.MIN, Align.MIN)
UP = (Align.CENTER, Align.CENTER, Align.MIN)


def block(x, y, z):
    """Return a box between two values of each coordinate."""
    return Pos(x[0], y[0], z[0]) * Box(x[1] - x[0], y[1] - y[0], z[1] - z[0], align=LOW)


def frame(leaf, high, gap, pin_d, play, track, track_high, lip, shoe_long, deep=70, jamb=40, sill=30, lintel=50, side=16):
    """Sill, lintel and two jambs; the lintel has a track with lips, open below."""
    left, right = -side, 2 * leaf + shoe_long / 2 + 8
    low, top, y = -gap, high + gap, (-deep / 2, deep / 2)
    body = block((left - jamb, right + jamb), y, (low - sill, top + lintel)) - block((left, right), (-deep, deep), (low, top))
    x = (leaf - shoe_long, right - 2)
    body -= block(x, (-track / 2, track / 2), (top + lip, top + lip + track_high))
    body -= block(x, (-pin_d / 2 - 1, pin_d / 2 + 1), (top - 1, top + lip + 1))
    return body - Pos(0, 0, low - 15) * Cylinder(pin_d / 2 + play, high + 2 * gap + 30, align=UP)


def leaf_first(leaf, high, thick, gap, pin_d, play, band, cut):
    """Along x from its pins; its knuckles are above and below."""
    half = thick / 2
    body = block((0, leaf - cut), (-half, half), (0, high)) + Cylinder(half, high, align=UP)
    for z in ((0, band), (high - band, high)):
        body += block((leaf - cut - 1, leaf), (-half, half), z) + Pos(leaf, 0, z[0]) * Cylinder(half, band, align=UP)
    body += Pos(0, 0, -gap - 12) * Cylinder(pin_d / 2, high + 2 * gap + 24, align=UP)
    return body - Pos(leaf, 0, -1) * Cylinder(pin_d / 2 + play, high + 2, align=UP)


def leaf_second(leaf, high, thick, gap, pin_d, band, cut, air, lip, track_high):
    """Along x from the hinge, whose knuckle is in the middle; its far pin points up."""
    half, z = thick / 2, (band + air, high - band - air)
    body = block((cut, leaf), (-half, half), (0, high)) + Pos(leaf, 0, 0) * Cylinder(half, high, align=UP)
    body += block((0, cut + 1), (-half, half), z) + Pos(0, 0, z[0]) * Cylinder(half, z[1] - z[0], align=UP)
    body += Cylinder(pin_d / 2, high, align=UP)
    return body + Pos(leaf, 0, high - 1) * Cylinder(pin_d / 2, 1 + gap + lip + track_high - 4, align=UP)


def shoe(shoe_long, track, track_high, shoe_gap, pin_d, play):
    body = Pos(0, 0, shoe_gap) * Box(shoe_long, track - 2 * shoe_gap, track_high - 2 * shoe_gap, align=UP)
    return body - Cylinder(pin_d / 2 + play, 4 * track_high)
