from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.MIN, Align.MIN, Align.MIN)


def board(wide, deep, high):
    return Box(wide, deep, high, align=LOW)


def bar_x(x0, x1, y, z, radius):
    """Return a round bar along x."""
    return Pos((x0 + x1) / 2, y, z) * Rot(0, 90, 0) * Cylinder(radius, x1 - x0)


def block(x0, x1, y0, y1, z0, z1):
    return Pos(x0, y0, z0) * Box(x1 - x0, y1 - y0, z1 - z0, align=LOW)


def ring(inner, outer, long):
    shape = Cylinder(outer, long, align=(Align.CENTER, Align.CENTER, Align.MIN))
    return shape - Pos(Z=-1) * Cylinder(inner, long + 2, align=(Align.CENTER, Align.CENTER, Align.MIN))


def post(radius, long):
    return Cylinder(radius, long, align=(Align.CENTER, Align.CENTER, Align.MIN))


def base(wide, deep, high, hole):
    shape = block(-wide / 2, wide / 2, -deep / 2, deep / 2, 0, high)
    for x in (-50, 50):
        for y in (-30, 30):
            shape -= Pos(x, y, 0) * Cylinder(hole / 2, 4 * high)
    return shape


cover = gasket_lower = gasket_upper = plate_lower = plate_upper = base
stud, bush = post, ring
