from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.MIN, Align.MIN, Align.MIN)


def board(wide, deep, high):
    return Box(wide, deep, high, align=LOW)


def bar_x(x0, x1, y, z, radius):
    """Return a round bar along x."""
    return Pos((x0 + x1) / 2, y, z) * Rot(0, 90, 0) * Cylinder(radius, x1 - x0)


def block(x0, x1, y0, y1, z0, z1):
    return Pos(x0, y0, z0) * Box(x1 - x0, y1 - y0, z1 - z0, align=LOW)


end_left = shelf = board


def bar_y(y0, y1, x, z, radius):
    return Pos(x, (y0 + y1) / 2, z) * Rot(90, 0, 0) * Cylinder(radius, y1 - y0)


def top(wide, deep, thick):
    return block(0, wide, -deep / 2, deep / 2, 830, 830 + thick)


def end_right(wide, deep, high):
    y = deep / 2
    shape = board(wide, deep, high) - block(-1, wide + 1, y - 20.3, y + 20.3, 799.5, high + 1)
    eye = bar_y(y + 81, y + 139, 40, 818, 8) + block(wide - 1, 40, y + 81, y + 139, 810, 818)
    return shape + eye


def leaf(wide, deep, thick, eye=20):
    shape = block(-19.5, wide - 19.5, -deep / 2, deep / 2, -10, thick - 10)
    for y in (60.7, 139.3):
        shape += bar_y(y, y + eye, 0, -22, 8) + block(-8, 8, y, y + eye, -22, -9)
    return shape


def batten(long, deep, high):
    return block(0, long, -deep / 2, deep / 2, 0, high)
