from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.MIN, Align.MIN, Align.MIN)


def board(wide, deep, high):
    return Box(wide, deep, high, align=LOW)


def bar_x(x0, x1, y, z, radius):
    """Return a round bar along x."""
    return Pos((x0 + x1) / 2, y, z) * Rot(0, 90, 0) * Cylinder(radius, x1 - x0)


def block(x0, x1, y0, y1, z0, z1):
    return Pos(x0, y0, z0) * Box(x1 - x0, y1 - y0, z1 - z0, align=LOW)


tread = board


def bracket(wide, deep, high, cheek=20, web=17.9):
    shape = block(0, wide, -deep / 2, deep / 2, -7, 0)
    shape += block(0, web, -deep / 2, deep / 2, -high, 0)
    return shape + block(0, wide, -deep / 2, cheek - deep / 2, -high + 5, 0) + block(0, wide, deep / 2 - cheek, deep / 2, -high + 5, 0)


def leg(wide, deep, long):
    return Rot(90, 0, 0) * Cylinder(wide / 2, deep) + block(-wide / 2, wide / 2, -deep / 2, deep / 2, -long, 0)
