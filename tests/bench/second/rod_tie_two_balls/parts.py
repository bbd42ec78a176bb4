from math import cos, radians, tan

from build123d import Align, Axis, Cone, Cylinder, Pos, Rot, Sphere, chamfer

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def rod(apart, rod, housing, housing_high, rod_z, ball_z, ball, play, stud, tilt_deg):
    """A housing at each end, whose mouth is narrower than the ball and leaves room for the tilted stud."""
    body = Rot(0, 90, 0) * Cylinder(rod / 2, apart - housing / 2)
    low, slope = stud / 2 / cos(radians(tilt_deg)) + 0.15, tan(radians(tilt_deg + 0.5))
    for x in (-apart / 2, apart / 2):
        shell = Pos(0, 0, -rod_z) * Cylinder(housing / 2, housing_high, align=UP)
        body += Pos(x, 0, 0) * chamfer(shell.edges(), 0.5)
    for x in (-apart / 2, apart / 2):
        body -= Pos(x, 0, ball_z - rod_z) * (Sphere(ball / 2 + play) + Cone(low, low + slope * housing, housing, align=UP))
    return body


def stud(ball, stud, stud_top, ball_z):
    body = Sphere(ball / 2) + Cylinder(stud / 2, stud_top - ball_z, align=UP)
    return chamfer(body.edges().sort_by(Axis.Z)[-1], 1)
