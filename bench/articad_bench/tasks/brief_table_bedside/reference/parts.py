from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.MIN, Align.MIN, Align.MIN)


def board(wide, deep, high):
    return Box(wide, deep, high, align=LOW)


def bar_x(x0, x1, y, z, radius):
    """Return a round bar along x."""
    return Pos((x0 + x1) / 2, y, z) * Rot(0, 90, 0) * Cylinder(radius, x1 - x0)


def block(x0, x1, y0, y1, z0, z1):
    return Pos(x0, y0, z0) * Box(x1 - x0, y1 - y0, z1 - z0, align=LOW)


arm = top = board


def base(long, deep, high):
    shape = block(0, high, -deep / 2, deep / 2, 0, high) + block(0, long, -deep / 2 , high - deep / 2, 0, high)
    return shape + block(0, long, deep / 2 - high, deep / 2, 0, high) + block(0, 70, -35, 35, 0, high)


def column(side, wall, high):
    inner = side - 2 * wall
    return block(-side / 2, side / 2, -side / 2, side / 2, 0, high) - block(-inner / 2, inner / 2, -inner / 2, inner / 2, -1, high + 1)


def post(side, high):
    return block(-side / 2, side / 2, -side / 2, side / 2, 0, high)


def castor(radius, high):
    return Cylinder(radius, high, align=(Align.CENTER, Align.CENTER, Align.MIN))
