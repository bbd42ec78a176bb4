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
    shape = block(-wide / 2, wide / 2, -deep, 0, 0, high)
    shape += bar_x(-40, 40, -50, 590, 10) + block(-40, 40, -50, -deep + 1, 580, 590)
    for z in (225, 550):
        shape += block(-25, 25, -43.5, -deep + 1, z, z + 20)
    return shape


def flap(wide, long, thick, eye=20):
    shape = block(-wide / 2, wide / 2, 10 - long, 10, 12, 12 + thick)
    for x in (-60.3, 40.3):
        shape += bar_x(x, x + eye, 0, 0, 10) + block(x, x + eye, -24, 10, 0, 13)
    return shape


def gate(long, thick, high):
    eye = Pos(Z=245.2) * Cylinder(thick / 2, 304.6, align=(Align.CENTER, Align.CENTER, Align.MIN))
    return eye + block(-thick / 2, thick / 2, -long, 0, 245.2, 549.8) + block(-thick / 2, thick / 2, -long, -80, 549, high)
