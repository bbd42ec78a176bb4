from math import acos, cos, pi, radians, sin, sqrt, tan

from build123d import Align, Box, Circle, Cylinder, Polygon, Pos, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def involute(alpha):
    return tan(alpha) - alpha


def flank(teeth, module, slack, steps=7):
    """Radius and half angle of the tooth, from its root to its tip."""
    pitch, tip, root = teeth * module / 2, (teeth + 2) * module / 2, (teeth - 2.5) * module / 2
    base, half = pitch * cos(radians(20)), (pi * module / 2 - slack) / 2 / pitch
    low = max(base, root)
    radii = [low + (tip - low) * k / steps for k in range(steps + 1)]
    points = [(r, half + involute(radians(20)) - involute(acos(base / r))) for r in radii]
    return ([(root, points[0][1])] if root < base else []) + points


def wheel(teeth, module, wide, bore, phase, slack=0.08):
    """Gear about z; a tooth lies at the angle of phase, counted in teeth."""
    outline, pitch = [], 2 * pi / teeth
    points = flank(teeth, module, slack)
    for tooth in range(teeth):
        middle = (tooth + phase) * pitch
        outline += [(r * cos(middle - a), r * sin(middle - a)) for r, a in points]
        outline += [(r * cos(middle + a), r * sin(middle + a)) for r, a in reversed(points)]
    return extrude(Polygon(*outline, align=None) - Circle(bore / 2), wide)


def small(small_count, module, wide, pin_d, play):
    return wheel(small_count, module, wide, pin_d + 2 * play, 0)


def large(large_count, module, wide, pin_d, play):
    return wheel(large_count, module, wide, pin_d + 2 * play, 0.5)


def plate(plate, small_x, distance, pin_d, top, long=140, deep=90):
    body = Box(long, deep, plate, align=UP)
    for x in (small_x, small_x + distance):
        body += Pos(x, 0, 0) * Cylinder(pin_d / 2, top, align=UP)
    return body
