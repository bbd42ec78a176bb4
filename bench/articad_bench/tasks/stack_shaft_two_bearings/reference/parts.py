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


bearing_near = bearing_far = spacer = circlip = ring


def shaft(radius, shoulder, long):
    return post(radius, long) + Pos(Z=-20) * post(shoulder, 20)
