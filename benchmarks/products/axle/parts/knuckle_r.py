from math import atan2, degrees, hypot

from build123d import Align, Box, Cylinder, Pos, Rot


def arm(x, y, d):
    long = hypot(x, y)
    bar = Pos(long / 2) * Box(long, 0.8 * d.eye, d.thick)
    return Rot(Z=degrees(atan2(y, x))) * bar + Pos(x, y) * Cylinder(d.eye, d.thick)


def build(part):
    d = part.dimensions
    body = Cylinder(d.barrel, d.high) + arm(-d.side * d.ax, -d.ay, d)
    body += Rot(Y=90 * d.side) * Cylinder(d.collar, d.shoulder, align=(Align.CENTER, Align.CENTER, Align.MIN))
    if "drag" in d:
        body += arm(0, d.drag, d)
    return part.made(body)
