from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.MIN, Align.MIN, Align.MIN)
UP = (Align.CENTER, Align.CENTER, Align.MIN)


def block(x, y, z):
    """Return a box between two values of each coordinate."""
    return Pos(min(x), min(y), min(z)) * Box(abs(x[1] - x[0]), abs(y[1] - y[0]), abs(z[1] - z[0]), align=LOW)


def leaf(side, knuckles, d, tall, hole_z, bore):
    """Plate towards the side, rolled round the axis at the knuckles' heights."""
    radius, thick, reach = d["knuckle_d"] / 2, d["thick"], d["reach"]
    body = block((side * (radius + d["side_play"]), side * reach), (radius - thick, radius), (0, tall))
    for low, high in knuckles:
        body += block((0, side * reach), (radius - thick, radius), (low, high)) + Pos(Z=low) * Cylinder(radius, high - low, align=UP)
    for k in (1, 3, 5):
        body -= Pos(side * d["hole_x"], 0, k * hole_z) * Rot(X=90) * Cylinder(d["hole_d"] / 2, 4 * radius)
    return body - Cylinder(bore / 2, 4 * tall)


def leaf_fixed(tall, split, hole_z, pin_d, reach, knuckle_d, thick, side_play, hole_d, hole_x, end_play):
    d = {"knuckle_d": knuckle_d, "thick": thick, "reach": reach, "side_play": side_play, "hole_d": hole_d, "hole_x": hole_x}
    return leaf(-1, ((0, split - end_play / 2), (tall - split + end_play / 2, tall)), d, tall, hole_z, pin_d)


def leaf_moving(tall, split, hole_z, pin_d, play, reach, knuckle_d, thick, side_play, hole_d, hole_x, end_play):
    d = {"knuckle_d": knuckle_d, "thick": thick, "reach": reach, "side_play": side_play, "hole_d": hole_d, "hole_x": hole_x}
    return leaf(1, ((split + end_play / 2, tall - split - end_play / 2),), d, tall, hole_z, pin_d + 2 * play)


def pin(tall, pin_d, head_d, head):
    """Shank below the origin, head above it."""
    return Cylinder(pin_d / 2, tall, align=(Align.CENTER, Align.CENTER, Align.MAX)) + Cylinder(head_d / 2, head, align=UP)
