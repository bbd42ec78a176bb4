from math import cos, radians, tan

from build123d import Align, Axis, Cone, Cylinder, Pos, Sphere, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def base(ball_d, rod_d, first, across=120, thick=16):
    body = Cylinder(across / 2, thick, align=UP)
    body = fillet(body.edges().group_by(Axis.Z)[-1], 2)
    return body + Cylinder(rod_d / 2, first, align=UP) + Pos(0, 0, first) * Sphere(ball_d / 2)


def cup(ball_d, play, cup_d, rod_d, mouth, cone_deg):
    """Outside and inside of a socket about the origin; its mouth lets the rod below lean by cone_deg."""
    outside = Sphere(cup_d / 2) & Pos(0, 0, -mouth / 2) * Cylinder(cup_d, 2 * cup_d, align=UP)
    outside += Cylinder(cup_d / 2, mouth, align=DOWN)
    slope, near = tan(radians(cone_deg + 0.5)), rod_d / 2 / cos(radians(cone_deg)) + 0.25
    return outside, Sphere(ball_d / 2 + play) + Pos(0, 0, -2 * mouth) * Cone(near + 2 * mouth * slope, near, 2 * mouth, align=UP)


def link(ball_d, play, cup_d, rod_d, mouth, cone_deg, pitch):
    outside, inside = cup(ball_d, play, cup_d, rod_d, mouth, cone_deg)
    body = outside + Cylinder(rod_d / 2, pitch, align=UP) + Pos(0, 0, pitch) * Sphere(ball_d / 2)
    return body - inside


def shade(ball_d, play, cup_d, rod_d, mouth, cone_deg, first, pitch, high, low_d=41, wide_d=90, wall=2, floor=3, seat=9.5):
    outside, inside = cup(ball_d, play, cup_d, rod_d, mouth, cone_deg)
    top = high - first - 4 * pitch
    body = outside + Pos(0, 0, seat) * Cone(low_d / 2, wide_d / 2, top - seat, align=UP)
    hollow = Cone(low_d / 2 - wall, wide_d / 2 - wall, top - seat, align=UP)
    return body - inside - Pos(0, 0, seat + floor) * hollow
