from math import hypot, sqrt

from build123d import Align, Axis, Cone, Cylinder, Plane, Polyline, Pos, ThreePointArc, make_face, revolve

DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def stem(stem_d, stem_long):
    return Cylinder(stem_d / 2, stem_long)


def foot(foot_high, stem_d, across=100, edge=4, land=4):
    """A spherical dome on a cylindrical edge, with a flat on top that is a land wider than the stem."""
    r, flat, rise = across / 2, stem_d / 2 + land, foot_high - edge
    down = (r * r - flat * flat - rise * rise) / (2 * rise)  # the sphere's centre below the edge's upper rim
    mid = (r + flat) / 2
    bulge = sqrt(hypot(r, down) ** 2 - mid * mid) - down + edge
    straight = Polyline((flat, foot_high), (0, foot_high), (0, 0), (r, 0), (r, edge))
    dome = ThreePointArc((r, edge), (mid, bulge), (flat, foot_high))
    return revolve(Plane.XZ * make_face([*straight.edges(), dome]), Axis.Z)


def cup(cup_high, stem_d, across=36, candle=22, candle_deep=25, straight=20):
    """Its brim is z = 0; below the straight part it narrows to the stem."""
    body = Cylinder(across / 2, straight, align=DOWN) + Pos(0, 0, -straight) * Cone(stem_d / 2 + 1, across / 2, cup_high - straight, align=DOWN)
    return body - Cylinder(candle / 2, candle_deep, align=DOWN)
