from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.MIN, Align.MIN, Align.MIN)


def board(wide, deep, high):
    return Box(wide, deep, high, align=LOW)


def bar_x(x0, x1, y, z, radius):
    """Return a round bar along x."""
    return Pos((x0 + x1) / 2, y, z) * Rot(0, 90, 0) * Cylinder(radius, x1 - x0)


def block(x0, x1, y0, y1, z0, z1):
    return Pos(x0, y0, z0) * Box(x1 - x0, y1 - y0, z1 - z0, align=LOW)


def frame(wide, deep, high):
    shape = block(-wide / 2, wide / 2, -deep / 2, deep / 2, 0, high) - block(-wide / 2 + 60, wide / 2 - 60, -deep / 2 + 60, deep / 2 - 60, -1, high + 1)
    for x in (-240, 210):
        shape += bar_x(x, x + 30, 400, 180, 20) + block(x, x + 30, 352, 420, 0, 180)
    return shape


def cover(side, thick):
    shape = block(-side / 2, side / 2, -side - 50, -50, -79.8, thick - 79.8)
    for x in (-280, 241):
        shape += block(x, x + 38, -150, -50, -79.8, 20) + block(x, x + 38, -51, 200, -20, 20)
    return shape


def bar(long, radius):
    return Rot(0, 90, 0) * Cylinder(radius, long)
