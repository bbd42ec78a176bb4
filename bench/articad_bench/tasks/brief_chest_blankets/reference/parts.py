from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.MIN, Align.MIN, Align.MIN)


def board(wide, deep, high):
    return Box(wide, deep, high, align=LOW)


def bar_x(x0, x1, y, z, radius):
    """Return a round bar along x."""
    return Pos((x0 + x1) / 2, y, z) * Rot(0, 90, 0) * Cylinder(radius, x1 - x0)


def block(x0, x1, y0, y1, z0, z1):
    return Pos(x0, y0, z0) * Box(x1 - x0, y1 - y0, z1 - z0, align=LOW)


floor = front = end_left = end_right = board


def rear(wide, deep, high, eye=60):
    middle = wide / 2
    lug = bar_x(middle - eye / 2, middle + eye / 2, 38, 425, 12) + block(middle - eye / 2, middle + eye / 2, deep - 1, 38, 413, 425)
    return board(wide, deep, high) + lug


def lid(long, deep, thick, eye=20):
    shape = block(-long / 2, long / 2, -470, deep - 470 + 1, 450 - thick - 440, 10)
    for x in (-50.3, 30.3):
        shape += bar_x(x, x + eye, 0, -15, 10) + block(x, x + eye, -10, 10, -15, 10) + block(x, x + eye, -60, 10, 450 - thick - 440, 10)
    return shape
