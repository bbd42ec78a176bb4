from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.MIN, Align.MIN, Align.MIN)


def board(wide, deep, high):
    return Box(wide, deep, high, align=LOW)


def bar_x(x0, x1, y, z, radius):
    """Return a round bar along x."""
    return Pos((x0 + x1) / 2, y, z) * Rot(0, 90, 0) * Cylinder(radius, x1 - x0)


def block(x0, x1, y0, y1, z0, z1):
    return Pos(x0, y0, z0) * Box(x1 - x0, y1 - y0, z1 - z0, align=LOW)


def bracket(wide, high, arm=22):
    shape = block(-wide / 2, wide / 2, -20, 0, 0, high)
    for z in (0, 70, 140, 210):
        shape += block(-12, 12, -57, -19, z + 15, z + 15 + arm)
    return shape - Pos(0, -45, 0) * Cylinder(5, 3 * high)


def rail(long, wide, high, eye=12):
    shape = block(-wide / 2, wide / 2, -long + eye, 0, 0, high) + Cylinder(eye, high, align=(Align.CENTER, Align.CENTER, Align.MIN))
    return shape - Cylinder(5.1, 3 * high)


def pin(radius, long):
    return Cylinder(radius, long, align=(Align.CENTER, Align.CENTER, Align.MIN)) + Pos(Z=long) * Cylinder(9, 5, align=(Align.CENTER, Align.CENTER, Align.MIN))
