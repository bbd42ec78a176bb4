"""Frame and cover from the front edge, arms about the axis of the pin, the bar about its own; all along x."""

from math import cos, radians, sin

from build123d import Align, Box, Cylinder, Polygon, Pos, Rot, extrude

LOW = (Align.MIN, Align.MIN, Align.MIN)
YZ = Rot(0, 90, 0) * Rot(0, 0, 90)


def block(x, y, z):
    """Return a box between two values of each coordinate."""
    return Pos(x[0], y[0], z[0]) * Box(x[1] - x[0], y[1] - y[0], z[1] - z[0], align=LOW)


def across(radius, long):
    return Rot(0, 90, 0) * Cylinder(radius, long)


def frame(side, thick, ledge, pin_y):
    inner, outer = side / 2 + 3, side / 2 + 33
    body = block((-outer, outer), (-33, pin_y + 25), (0, ledge + thick))
    body -= block((40 - side / 2, side / 2 - 40), (40, side - 40), (-1, ledge + 1))
    body -= block((-inner, inner), (-3, pin_y + 30), (ledge, ledge + 2 * thick))
    return body - block((-inner, inner), (side + 8, pin_y + 30), (-1, ledge + 1))


def cover(side, thick):
    return Pos(Y=side / 2) * Box(side, side, thick, align=(Align.CENTER, Align.CENTER, Align.MIN))


def arm(arm, pin_y, thick, radius, rise_deg, bar):
    """A plate from the cover past the pin to the bar, with a flange on the cover."""
    y, z = radius * cos(radians(rise_deg)), radius * sin(radians(rise_deg))
    low = thick / 2
    outline = [(-240, low), (-240, low + 12), (-60, low + 26), (0, low + 26), (y - 10, z + 12), (y + 10, z - 12), (8, -16), (-8, -16), (-18, 0), (-18, low)]
    plate = extrude(YZ * Polygon(*outline, align=None), arm / 2, both=True)
    plate += across(18, arm) + Pos(0, y, z) * across(bar / 2 + 7, arm)
    plate += block((-25, 25), (-240, -30), (low, low + 6))
    return plate - across(8.15, 4 * arm) - Pos(0, y, z) * across(bar / 2, 4 * arm)


def bar(bar, long):
    return across(bar / 2, long)
