"""Frames have the axes of the assembly; a leg's origin is the middle of its cardan joint. The first axis of that joint is level, x of leg_plane."""

from math import cos, radians, sin, tan

from build123d import Align, Axis, Box, Cone, Cylinder, Plane, Pos, Rot, Sphere, Vector, chamfer

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def way(hand, base_r, top_r, half_low_deg, half_top_deg, low_z, high_z):
    """From the foot of the first or second leg to its head, and that foot."""
    low, top = radians(hand * half_low_deg), radians(hand * (60 - half_top_deg))
    foot = Vector(base_r * cos(low), base_r * sin(low), low_z)
    return Vector(top_r * cos(top), top_r * sin(top), high_z) - foot, foot


def leg_plane(up, origin=(0, 0, 0)):
    return Plane(origin, x_dir=(-up.Y, up.X, 0), z_dir=up)


def base(base_r, top_r, half_low_deg, half_top_deg, low_z, high_z, pin_d, play, plate=12, lug=8, lug_wide=16, inside=12.3):
    body = Cylinder(base_r + 40, plate, align=UP)
    bores = []
    for k in range(3):
        for hand in (-1, 1):
            up, foot = way(hand, base_r, top_r, half_low_deg, half_top_deg, low_z, high_z)
            level = Rot(0, 0, 120 * k) * Plane(foot, x_dir=(-up.Y, up.X, 0), z_dir=(0, 0, 1)).location
            for side in (-1, 1):
                at = level * Pos(side * (inside + lug / 2), 0, 0)
                body += at * Box(lug, lug_wide, low_z - plate + 1, align=DOWN) + at * Rot(Y=90) * Cylinder(lug_wide / 2, lug)
            bores.append(level * Rot(Y=90) * Cylinder(pin_d / 2 + play, 2 * (inside + lug) + 2))
    for bore in bores:
        body -= bore
    return body


def spider(hand, base_r, top_r, half_low_deg, half_top_deg, low_z, high_z, pin_d, reach=20):
    up, _ = way(hand, base_r, top_r, half_low_deg, half_top_deg, low_z, high_z)
    return leg_plane(up) * (Rot(X=90) * Cylinder(pin_d / 2, 2 * reach) + Rot(Y=90) * Cylinder(pin_d / 2, 2 * reach) + Box(16, 16, 12))


def barrel(
    hand,
    base_r,
    top_r,
    half_low_deg,
    half_top_deg,
    low_z,
    high_z,
    pin_d,
    play,
    lug=8,
    lug_wide=14,
    inside=12.3,
    shelf=20,
    rod_d=14,
    outer_d=24,
    long=112,
):
    """A fork for the second pins of the spider, and a tube."""
    up, _ = way(hand, base_r, top_r, half_low_deg, half_top_deg, low_z, high_z)
    body = Pos(0, 0, shelf) * Cylinder(inside + lug + 1, 8, align=UP) + Pos(0, 0, shelf + 4) * Cylinder(
        outer_d / 2, long - shelf - 4, align=UP
    )
    for side in (-1, 1):
        at = Pos(0, side * (inside + lug / 2), 0)
        body += at * Box(lug_wide, lug, shelf + 1, align=UP) + at * Rot(X=90) * Cylinder(lug_wide / 2, lug)
    body -= Rot(X=90) * Cylinder(pin_d / 2 + play, 100)
    return leg_plane(up) * (body - Pos(0, 0, shelf + 14) * Cylinder(rod_d / 2 + play, long, align=UP))


def ram(hand, base_r, top_r, half_low_deg, half_top_deg, low_z, high_z, ball_d, neck_d, stroke, rod_d=14, shelf=34):
    up, _ = way(hand, base_r, top_r, half_low_deg, half_top_deg, low_z, high_z)
    long, start = up.length, shelf + stroke / 2 + 6
    rod = Pos(0, 0, start) * Cylinder(rod_d / 2, long - 20 - start, align=UP)
    rod = chamfer(rod.edges().group_by(Axis.Z)[-1], 2)
    return leg_plane(up) * (rod + Pos(0, 0, long - 22) * Cylinder(neck_d / 2, 22, align=UP) + Pos(0, 0, long) * Sphere(ball_d / 2))


def platform(base_r, top_r, half_low_deg, half_top_deg, low_z, high_z, ball_d, neck_d, tip_deg, plate=10, above=8, cup_d=25, gap=0.2):
    """A round plate with six cups below, whose middles are in z = 0."""
    body = Pos(0, 0, above) * Cylinder(top_r + 25, plate, align=UP)
    low = neck_d / 2 / cos(radians(tip_deg)) + gap
    hollow = Sphere(ball_d / 2 + gap) + Cone(low, low + 20 * tan(radians(tip_deg + 1)), 20, align=UP)
    places = []
    for k in range(3):
        for hand in (-1, 1):
            up, foot = way(hand, base_r, top_r, half_low_deg, half_top_deg, low_z, high_z)
            head = foot + up - Vector(0, 0, high_z)
            places.append(Rot(0, 0, 120 * k) * Plane(head, x_dir=(-up.Y, up.X, 0), z_dir=-up).location)
    for place in places:
        body += place * Sphere(cup_d / 2)
    for place in places:
        body -= place * hollow
    return body
