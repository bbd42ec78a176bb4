from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.MIN, Align.MIN, Align.MIN)


def board(wide, deep, high):
    return Box(wide, deep, high, align=LOW)


def bar_x(x0, x1, y, z, radius):
    """Return a round bar along x."""
    return Pos((x0 + x1) / 2, y, z) * Rot(0, 90, 0) * Cylinder(radius, x1 - x0)


def block(x0, x1, y0, y1, z0, z1):
    return Pos(x0, y0, z0) * Box(x1 - x0, y1 - y0, z1 - z0, align=LOW)


base = top = board


def column(side, high):
    return block(-side / 2, side / 2, -side / 2, side / 2, 0, high)


def table(side, wall, high):
    s, t = side / 2, side / 2 + wall
    plate = block(-160, 160, -140, 140, high - 20, high)
    return block(-t, t, -t, t, 0, high) - block(-s, s, -s, s, -1, high - 20) + plate


def crank(long, radius):
    arm = block(-19.7, 20, -15, 15, -15, 15) + block(2, 20, -10, 10, -long + radius, 0)
    return arm + Pos(20, 0, -long + radius) * Rot(0, 90, 0) * Cylinder(radius, 90, align=(Align.CENTER, Align.CENTER, Align.MIN))
