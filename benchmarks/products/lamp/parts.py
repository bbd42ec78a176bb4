from build123d import *

C = Align.CENTER
LOW, TOP = (C, C, Align.MIN), (C, C, Align.MAX)


def hull(t, eye, *ends):
    edges = [edge for x, z in ends for edge in (Pos(x, z) * Circle(eye)).edges()]
    return extrude(Plane.XZ * make_hull(edges), t / 2, both=True)


def foot(radius=90, thick=20):
    return Cylinder(radius, thick, align=LOW)


def turntable(p, t, h, gap, radius=40, disc=25):
    return Pos(Z=gap) * (Cylinder(radius, disc, align=LOW) + Box(p + 28, t, h - 6, align=LOW))


def lower(long, bar, gap, wide=14):
    return Pos(0, -gap, long / 2) * extrude(Plane.XZ * SlotCenterToCenter(long, wide, rotation=90), bar)


def upper(long, bar, gap, wide=14):
    return Pos(long / 2, gap + bar) * extrude(Plane.XZ * SlotCenterToCenter(long, wide), bar)


def elbow(p, t, ez, eye=12):
    return hull(t, eye, (-p / 2, 0), (p / 2, 0), (0, ez), (0, ez + p))


def head(p, t, out, down, eye=10):
    return hull(t, eye, (0, 0), (0, p)) + hull(t, eye, (0, 0), (out, -down))


def shade(t, gap, radius=60, wall=3, high=100, top=4, drop=14, ear=20, ear_thick=6):
    cup = Pos(Z=-drop) * (Cylinder(radius, high, align=TOP) - Pos(Z=-top) * Cylinder(radius - wall, high, align=TOP))
    for side in (-1, 1):
        y = side * (t / 2 + gap + ear_thick / 2)
        cup += Pos(0, y) * (Box(ear, ear_thick, drop + 1, align=TOP) + Rot(X=90) * Cylinder(ear / 2, ear_thick))
    return cup


def bulb(neck=12, neck_long=30, ball=22):
    return Cylinder(neck, neck_long, align=TOP) + Pos(Z=-neck_long - 0.8 * ball) * Sphere(ball)
