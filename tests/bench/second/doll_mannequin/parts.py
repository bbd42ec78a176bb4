"""The limbs are drawn along +x of a frame in their inner joint and turned into place."""

from math import cos, radians, tan

from build123d import Align, Axis, Box, Cone, Cylinder, Pos, Rot, Sphere, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def rod(x, length, radius):
    return Pos(x, 0, 0) * Rot(Y=90) * Cylinder(radius, length, align=UP)


def hollow(ball_d, stem_d, gap, tip_deg):
    """Room for a ball about the origin and for its stem along +z."""
    low = stem_d / 2 / cos(radians(tip_deg)) + gap
    return Sphere(ball_d / 2 + gap) + Cone(low, low + 20 * tan(radians(tip_deg + 1)), 20, align=UP)


def torso(neck_z, shoulder_x, shoulder_z, hip_x, hip_z, ball_d, stem_d, cup_d, gap, tip_deg, chest=72, deep=32):
    chest_box = Pos(0, 0, 218) * Box(chest, deep, 48, align=UP)
    body = fillet(chest_box.edges().filter_by(Axis.Z), 6) + Pos(0, 0, 178) * Cylinder(12, 50, align=UP)
    body += Pos(0, 0, 164) * Box(60, 26, 26, align=UP) + Pos(0, 0, 260) * Cylinder(9, neck_z - 260 - 4, align=UP)
    places = [Pos(0, 0, neck_z), Pos(shoulder_x, 0, shoulder_z) * Rot(Y=90), Pos(-shoulder_x, 0, shoulder_z) * Rot(Y=-90)]
    places += [Pos(x, 0, hip_z) * Rot(X=180) for x in (-hip_x, hip_x)]
    for place in places:
        body += place * Sphere(cup_d / 2)
    for place in places:
        body -= place * hollow(ball_d, stem_d, gap, tip_deg)
    return body


def head(neck_z, high, ball_d, stem_d, across=44):
    middle = high - neck_z - across / 2
    return Sphere(ball_d / 2) + Cylinder(stem_d / 2, middle, align=UP) + Pos(0, 0, middle) * Sphere(across / 2)


def upper(long, ball_d, stem_d, fork_slot, pin_d, across, start=15):
    """Ball, stem, limb and fork; the fork's pin is along z, at the end of the limb."""
    limb = rod(start, long - start, across / 2) + Pos(long, 0, 0) * Cylinder(across / 2, across)
    limb &= rod(0, 2 * long, across / 2)
    limb -= Pos(long + across, 0, 0) * Box(2 * across + 21, 2 * across, fork_slot)
    return limb + Sphere(ball_d / 2) + rod(0, start + 5, stem_d / 2) + Pos(long, 0, 0) * Cylinder(pin_d / 2, across - 3)


def lower(long, tongue, pin_d, play, across, start=11.5):
    """Tongue about the origin, bored along z, and the limb along +x."""
    flat = Cylinder(5, tongue) + Pos(8, 0, 0) * Box(16, 10, tongue)
    return flat + rod(start, long - start, across / 2) - Cylinder(pin_d / 2 + play, 2 * across)


def upper_arm_l(shoulder_x, elbow_x, ball_d, stem_d, fork_slot, pin_d, arm=14):
    return upper(elbow_x - shoulder_x, ball_d, stem_d, fork_slot, pin_d, arm)


def forearm_l(elbow_x, whole, tongue, pin_d, play, arm=14):
    return lower(whole / 2 - elbow_x, tongue, pin_d, play, arm)


def upright(limb):
    """From along x to along -z, with the pin along x."""
    return Rot(0, 90, 0) * limb


def thigh_l(hip_z, knee_z, ball_d, stem_d, fork_slot, pin_d, leg=16):
    return upright(upper(hip_z - knee_z, ball_d, stem_d, fork_slot, pin_d, leg))


def shank_l(knee_z, tongue, pin_d, play, leg=16, sole=8, front=30, heel=10):
    foot = Pos(0, (heel - front) / 2, -knee_z) * Box(leg, front + heel, sole, align=UP)
    return upright(lower(knee_z - 1, tongue, pin_d, play, leg, start=13)) + foot
