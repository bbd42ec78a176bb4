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


def knuckles(places, side, long, wide, thick, outer, bore):
    shape = block(min(side * (outer + 1), side * wide), max(side * (outer + 1), side * wide), -thick - 0.3, -0.3, 0, long)
    for low, high in places:
        near = block(min(0, side * (outer + 2)), max(0, side * (outer + 2)), -thick - 0.3, -0.3, low, high)
        shape += near + Pos(Z=low) * Cylinder(outer, high - low, align=(Align.CENTER, Align.CENTER, Align.MIN))
    return shape - Cylinder(bore / 2, 3 * long)


def leaf_fixed(long, wide, thick, outer, bore):
    return knuckles([(0, 20), (40.1, 60.1), (80.2, 100.2)], -1, long, wide, thick, outer, bore)


def leaf_swinging(long, wide, thick, outer, bore):
    return knuckles([(20.05, 40.05), (60.15, 80.15)], 1, long, wide, thick, outer, bore)


def pin(radius, long):
    return Cylinder(radius, long, align=(Align.CENTER, Align.CENTER, Align.MIN)) + Pos(Z=-4) * Cylinder(7, 4, align=(Align.CENTER, Align.CENTER, Align.MIN))
