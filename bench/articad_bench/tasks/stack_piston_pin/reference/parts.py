from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.MIN, Align.MIN, Align.MIN)


def board(wide, deep, high):
    return Box(wide, deep, high, align=LOW)


def bar_x(x0, x1, y, z, radius):
    """Return a round bar along x."""
    return Pos((x0 + x1) / 2, y, z) * Rot(0, 90, 0) * Cylinder(radius, x1 - x0)


def block(x0, x1, y0, y1, z0, z1):
    return Pos(x0, y0, z0) * Box(x1 - x0, y1 - y0, z1 - z0, align=LOW)


def across(radius, x0, x1):
    return bar_x(x0, x1, 0, 0, radius)


def piston(radius, high, bore, bosses, between, counter=16):
    shape = Pos(Z=-20) * Cylinder(radius, high, align=(Align.CENTER, Align.CENTER, Align.MIN))
    shape -= block(-bosses / 2, bosses / 2, -20.5, 20.5, -21, 18)
    shape -= across(bore / 2, -2 * radius, 2 * radius)
    return shape - across(counter / 2, between / 2, 2 * radius) - across(counter / 2, -2 * radius, -between / 2)


def pin(outer, inner, long):
    return across(outer, -long / 2, long / 2) - across(inner, -long, long)


def ring(inner, outer, long):
    return across(outer, 0, long) - across(inner, -1, long + 1)


def rod(bore, outer, wide, long):
    shape = across(outer, -wide / 2, wide / 2) + block(-wide / 2, wide / 2, -6, 6, -long, 0)
    return shape - across(bore / 2, -wide, wide)
