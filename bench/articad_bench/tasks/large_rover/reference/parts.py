from math import atan2, degrees, hypot

from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)
LEFT = Rot(X=-90)  # turns z into y


def bar(x1, z1, x2, z2, y, thick, high=40):
    """A flat bar with round ends between two points, standing across y."""
    body = Pos((x1 + x2) / 2, y, (z1 + z2) / 2) * Rot(Y=-degrees(atan2(z2 - z1, x2 - x1))) * Box(hypot(x2 - x1, z2 - z1), thick, high)
    for x, z in ((x1, z1), (x2, z2)):
        body += Pos(x, y, z) * LEFT * Cylinder(high / 2, thick)
    return body


def boss(x, track, y, thick, boss_z):
    """An arm that reaches sideways over the wheel, with a bore for the kingpin."""
    arm = Pos(x, y - thick / 2, boss_z) * Box(40, track + 20 - y + thick / 2, 30, align=(Align.CENTER, Align.MIN, Align.CENTER))
    return arm, Pos(x, track, boss_z) * Cylinder(6.1, 80)


def body(long, wide, high, rocker_x, rocker_z, pin, low):
    shell = Pos(0, 0, low) * Box(long, wide, high, align=LOW) + Pos(0, 0, low) * Box(300, 200, 210, align=LOW)
    return shell - Pos(rocker_x + 60, 0, rocker_z) * LEFT * Cylinder(pin / 2, 2 * wide) + Pos(0, 0, low) * Box(long - 20, wide - 70, 20, align=LOW)


def deck(long, wide, thick):
    return Box(long, wide, thick, align=LOW)


def mast(across, high):
    return Cylinder(across / 2, high, align=LOW) - Pos(0, 0, high - 40) * Cylinder(8.1, 41, align=LOW)


def head(wide, deep, high):
    return Box(deep, wide, high, align=LOW) + Pos(0, 0, -40) * Cylinder(8, 41, align=LOW)


def rocker(rocker_x, rocker_z, bogie_x, bogie_z, base, track, boss_z, pin, rocker_y, thick):
    arm, bore = boss(base, track, rocker_y, thick, boss_z)
    plate = bar(rocker_x, rocker_z, base, boss_z + 5, rocker_y, thick) + bar(rocker_x, rocker_z, bogie_x, bogie_z, rocker_y, thick)
    for x, z, size in ((rocker_x, rocker_z, pin + 0.2), (bogie_x, bogie_z, pin)):
        plate -= Pos(x, rocker_y, z) * LEFT * Cylinder(size / 2, 2 * thick)
    return plate + arm - bore


def bogie(bogie_x, bogie_z, base, track, boss_z, pin, bogie_y, axle_z, thick):
    arm, bore = boss(-base, track, bogie_y, thick, boss_z)
    plate = bar(bogie_x, bogie_z + 14, -base, bogie_z + 14, bogie_y, thick) + bar(bogie_x, bogie_z, 0, axle_z, bogie_y, thick)
    plate -= Pos(bogie_x, bogie_y, bogie_z) * LEFT * Cylinder(pin / 2 + 0.1, 2 * thick) + Pos(0, bogie_y, axle_z) * LEFT * Cylinder(5, 2 * thick)
    return plate + arm - bore


def rocker_bolt(pin, long, head):
    """Its frame is where the shank leaves the head."""
    return LEFT * (Cylinder(pin / 2, long - 4, align=HIGH) + Cylinder(head / 2, 8, align=LOW))


bogie_bolt = rocker_bolt


def knuckle_front(track, axle_z, top):
    """A plate over the wheel and one beside it, seen from the axis of the kingpin on the ground."""
    body = Pos(0, -68, top) * Box(60, 98, 12, align=(Align.CENTER, Align.MIN, Align.MIN))
    body += Pos(0, -68, axle_z - 30) * Box(60, 12, top + 12 - axle_z + 30, align=(Align.CENTER, Align.MIN, Align.MIN))
    return body - Pos(0, -60, axle_z) * LEFT * Cylinder(5, 40) - Pos(0, 0, top) * Cylinder(6, 40)


knuckle_rear = knuckle_front


def kingpin_front(across, long):
    return Cylinder(across / 2, long, align=LOW)


kingpin_rear = kingpin_front


def ring_front(outer, bore, wide):
    return Cylinder(outer / 2, wide, align=LOW) - Cylinder(bore / 2, 20)


ring_rear = ring_front


def motor_front(across, long, shaft, out):
    """Its frame is on its face; the shaft points outwards."""
    return LEFT * (Cylinder(across / 2, long, align=HIGH) + Cylinder(shaft / 2, out, align=LOW))


motor_middle = motor_rear = motor_front


def wheel_front(across, wide, shaft):
    """A wheel that is open toward the outside."""
    return LEFT * (Cylinder(across / 2, wide) - Pos(0, 0, 15) * Cylinder(across / 2 - 20, wide) + Cylinder(20, 60) - Cylinder(shaft / 2 + 0.1, 2 * wide))


wheel_middle = wheel_rear = wheel_front
