from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.MIN, Align.MIN, Align.MIN)
UP = (Align.CENTER, Align.CENTER, Align.MIN)


def block(x, y, z):
    """Return a box between two values of each coordinate."""
    return Pos(min(x), min(y), min(z)) * Box(abs(x[1] - x[0]), abs(y[1] - y[0]), abs(z[1] - z[0]), align=LOW)


def leaf(hand, places, knuckle, step, outer_d, reach, thick, side, bore):
    """Plate on the side of the hand with knuckles at the places; z = 0 is the lowest knuckle's lower face."""
    radius, tall = outer_d / 2, 4 * step + knuckle
    y = (radius - thick, radius)
    body = block((hand * (radius + side), hand * reach), y, (0, tall))
    for k in places:
        body += block((0, hand * reach), y, (k * step, k * step + knuckle)) + Pos(Z=k * step) * Cylinder(radius, knuckle, align=UP)
    for x in (0.45 * reach, 0.8 * reach):
        for z in (0.15 * tall, 0.85 * tall):
            body -= Pos(hand * x, 0, z) * Rot(X=90) * Cylinder(2.75, 4 * radius)
    return body - Cylinder(bore / 2, 3 * tall)


def leaf_frame(knuckle, step, outer_d, reach, thick, side, pin_d):
    return leaf(-1, (0, 2, 4), knuckle, step, outer_d, reach, thick, side, pin_d)


def leaf_door(knuckle, step, outer_d, reach, thick, side, bore_d):
    return leaf(1, (1, 3), knuckle, step, outer_d, reach, thick, side, bore_d)


def pin(pin_d, head, seat, ring, head_d=16):
    body = Cylinder(pin_d / 2, seat + ring, align=UP)
    return body + Cylinder(head_d / 2, head, align=(Align.CENTER, Align.CENTER, Align.MAX))


def ring(pin_d, ring, ring_d):
    return Cylinder(ring_d / 2, ring, align=UP) - Cylinder(pin_d / 2, 3 * ring)
