from math import cos, radians, sin

from build123d import Align, Box, Cylinder, Pos, Rot, Sphere

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def frame(tall, tube_d, across, wheel_d, axle_y, axle_d, grip=150, rung_d=19, plate=5, plate_wide=430, plate_front=242, plate_back=31):
    """Two uprights with grips, a top bar, four rungs, the toe plate and brackets for the axle, welded."""
    r, top = tube_d / 2, tall - tube_d / 2
    body = Pos(0, (plate_back - plate_front) / 2, 0) * Box(plate_wide, plate_front + plate_back, plate, align=UP)
    for x in (-across / 2, across / 2):
        body += Pos(x, 0, plate / 2) * Cylinder(r, top - plate / 2, align=UP) + Pos(x, 0, top) * Sphere(r)
        body += Pos(x, 0, top) * Rot(X=-90) * Cylinder(r, grip, align=UP)
        body += Pos(x, (axle_y + 18) / 2, wheel_d / 2) * Box(12, axle_y + 18, 40)
    body += Pos(0, 0, top) * Rot(Y=90) * Cylinder(r, across)
    for z in (170, 440, 710, 980):
        body += Pos(0, 0, z) * Rot(Y=90) * Cylinder(rung_d / 2, across)
    return body - Pos(0, axle_y, wheel_d / 2) * Rot(Y=90) * Cylinder(axle_d / 2, 2 * across)


def axle(axle_d, track, hub_wide, end, end_d=38):
    """Along x, with a collar outside of each wheel."""
    half = (track + hub_wide) / 2 + 1
    body = Rot(Y=90) * Cylinder(axle_d / 2, 2 * half)
    for side in (-1, 1):
        body += Pos(side * (half + end / 2), 0, 0) * Rot(Y=90) * Cylinder(end_d / 2, end)
    return body


def wheel(wheel_d, axle_d, hub_wide, wide=60, rim_d=180, web=24, hub_d=60, hole_d=32, hole_circle=116, play=0.25):
    """About x: tyre, a thinner disc with six holes, hub."""
    body = Cylinder(wheel_d / 2, wide)
    for side in (-1, 1):
        body -= Pos(0, 0, side * (web + wide) / 2) * Cylinder(rim_d / 2, wide)
    for i in range(6):
        a = radians(60 * i)
        body -= Pos(hole_circle / 2 * cos(a), hole_circle / 2 * sin(a), 0) * Cylinder(hole_d / 2, 2 * wide)
    body += Cylinder(hub_d / 2, hub_wide)
    return Rot(Y=90) * (body - Cylinder(axle_d / 2 + play, 2 * hub_wide))
