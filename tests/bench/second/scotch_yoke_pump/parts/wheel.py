from math import cos, radians, sin

from build123d import Align, Circle, Cylinder, Pos, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def wheel(throw, start_deg, gap, axle_d, pin_d, radius=36, thick=7.9, total=19.6):
    disc = extrude(Circle(radius) - Circle(axle_d / 2 + gap), thick)
    return disc + Pos(throw * cos(radians(start_deg)), throw * sin(radians(start_deg)), thick / 2) * Cylinder(pin_d / 2, total - thick / 2, align=UP)
