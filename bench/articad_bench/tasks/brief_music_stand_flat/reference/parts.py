from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.MIN, Align.MIN, Align.MIN)


def board(wide, deep, high):
    return Box(wide, deep, high, align=LOW)


def bar_x(x0, x1, y, z, radius):
    """Return a round bar along x."""
    return Pos((x0 + x1) / 2, y, z) * Rot(0, 90, 0) * Cylinder(radius, x1 - x0)


def block(x0, x1, y0, y1, z0, z1):
    return Pos(x0, y0, z0) * Box(x1 - x0, y1 - y0, z1 - z0, align=LOW)


foot = board


def post(wide, deep, high):
    return block(0, wide, 0, deep, 0, high - 40) + block(0, wide, 0, deep, high - 40, high)


def strut(wide, deep, long):
    return block(-wide / 2, wide / 2, -deep / 2, deep / 2, -long, 15)


def desk(wide, high, thick, lug=20.9):
    plate = block(-wide / 2, wide / 2, -15 - thick, -15, 70 - high, 70) + block(-wide / 2, wide / 2, -45, -15 - thick, 70 - high, 80 - high)
    for x in (-30.3 - lug, 30.3):
        plate += block(x, x + lug, -15, 6, -6, 6)
    return plate
