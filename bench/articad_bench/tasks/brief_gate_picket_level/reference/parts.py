from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.MIN, Align.MIN, Align.MIN)


def board(wide, deep, high):
    return Box(wide, deep, high, align=LOW)


def bar_x(x0, x1, y, z, radius):
    """Return a round bar along x."""
    return Pos((x0 + x1) / 2, y, z) * Rot(0, 90, 0) * Cylinder(radius, x1 - x0)


def block(x0, x1, y0, y1, z0, z1):
    return Pos(x0, y0, z0) * Box(x1 - x0, y1 - y0, z1 - z0, align=LOW)


def post(wide, deep, high):
    return block(-wide / 2, wide / 2, 0, deep, 30, high)


def foot(long, deep, high):
    return block(-long / 2, long / 2, -deep / 2, deep / 2, 0, high)


def arm(rear, front, wide, high):
    return block(-rear, front, -wide, 0, -high / 2, high / 2)


arm_upper = arm_lower = arm


def picket(wide, deep, low, high):
    return block(-wide / 2, wide / 2, 0, deep, -low, high)


def weight(long, wide, high):
    return block(-long / 2, long / 2, -wide / 2, wide / 2, -high / 2, high / 2) - block(-long, long, -10, 10, -15, 15)
