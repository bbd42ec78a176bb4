from math import cos, radians, tan

from build123d import Align, Cone, Cylinder, Pos, Sphere


def shoe(ball_d, neck_d, pad_down, tilt_deg, across=28, tall=10.5, gap=0.2):
    """A disc with a socket about the origin; its mouth leaves room for the tilted neck."""
    disc = Pos(0, 0, -pad_down) * Cylinder(across / 2, tall, align=(Align.CENTER, Align.CENTER, Align.MIN))
    disc -= Sphere(ball_d / 2 + gap)
    slope, low = tan(radians(tilt_deg + 1)), neck_d / 2 / cos(radians(tilt_deg)) + gap
    return disc - Cone(low, low + slope * tall, tall, align=(Align.CENTER, Align.CENTER, Align.MIN))
