from math import cos, radians, sin

from build123d import Align, Axis, Cone, Cylinder, Pos, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def seat(seat_d, seat, leg_d, circle, sunk):
    body = Cylinder(seat_d / 2, seat, align=DOWN)
    body = fillet(body.edges().group_by(Axis.Z)[-1], 3)
    for i in range(3):
        a = radians(120 * i)
        body -= Pos(circle / 2 * cos(a), circle / 2 * sin(a), -seat) * Cylinder(leg_d / 2, 2 * sunk)
    return body


def leg(high, seat, leg_d, sunk, taper=58, foot_d=28):
    """Round, drawn in at the foot; its upper end sits in the seat."""
    return Cone(foot_d / 2, leg_d / 2, taper, align=UP) + Pos(0, 0, taper) * Cylinder(leg_d / 2, high - seat + sunk - taper, align=UP)
