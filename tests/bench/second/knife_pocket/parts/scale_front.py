from build123d import Align, Box, Cylinder, Pos, Rot


def scale_front(long, high, scale, notch=8):
    side = Box(long, scale, high, align=(Align.MIN, Align.MIN, Align.MIN))
    for x in (0, long):
        side -= Pos(x, scale / 2, high) * Rot(X=90) * Cylinder(notch, 2 * scale)
    return side
