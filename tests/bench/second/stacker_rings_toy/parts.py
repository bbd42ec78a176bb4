from build123d import Align, Box, Circle, Cylinder, Pos, Sphere, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def base(base_d, base_high, peg_d, cap_z, tenon_d, tenon):
    """Disc and peg, turned of one piece; the cap fits on the tenon."""
    body = Cylinder(base_d / 2, base_high, align=UP) + Cylinder(peg_d / 2, cap_z, align=UP)
    return body + Cylinder(tenon_d / 2, cap_z + tenon, align=UP)


def ring(across, ring_high, hole_d):
    return extrude(Circle(across / 2) - Circle(hole_d / 2), -ring_high)


def cap(ball_d, cap_high, tenon_d, tenon):
    """A ball about the origin with a flat below and a blind hole in it."""
    flat = ball_d / 2 - cap_high
    ball = Sphere(ball_d / 2) & Pos(0, 0, flat) * Box(2 * ball_d, 2 * ball_d, 2 * ball_d, align=UP)
    return ball - Pos(0, 0, flat) * Cylinder(tenon_d / 2, tenon, align=UP)
