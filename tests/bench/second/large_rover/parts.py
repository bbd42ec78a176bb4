"""Parts of the rover. Side 1 is the left (+y), -1 the right; y counts outwards within `across` and `bar`."""

from math import atan2, degrees, hypot

from build123d import Align, Box, Cylinder, Pos, Rot

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def across(side, diameter, start, end, x=0, z=0):
    """Cylinder along y, from start to end outwards."""
    return Pos(x, side * (start + end) / 2, z) * Rot(90, 0, 0) * Cylinder(diameter / 2, end - start)


def bar(side, wide, start, end, to_x, to_z, x=0, z=0):
    """Flat bar in the plane of the wheels, from (x, z) to (to_x, to_z)."""
    turn = Rot(0, -degrees(atan2(to_z - z, to_x - x)), 0)
    flat = Box(hypot(to_x - x, to_z - z), end - start, wide)
    return Pos((x + to_x) / 2, side * (start + end) / 2, (z + to_z) / 2) * turn * flat


def body(
    body_long, body_wide, body_high, body_z, rocker_x, rocker_z, shank, rocker_bolt, head_high, gap, rocker_thick, air, step=40, wall=40
):
    """Open below; its raised middle carries the deck."""
    base = Box(body_long, body_wide, body_high - step, align=UP)
    base += Box(body_long - 180, body_wide - 120, body_high, align=UP)
    base -= Pos(0, 0, -1) * Box(body_long - 2 * wall, body_wide - 2 * wall, body_high - step - 11, align=UP)
    deep = rocker_bolt - head_high - gap - rocker_thick - air
    for side in (-1, 1):
        base -= across(side, shank, body_wide / 2 - deep, body_wide, rocker_x, rocker_z - body_z)
    return base


def deck(deck_long, deck_wide, deck_thick):
    return Box(deck_long, deck_wide, deck_thick, align=UP)


def mast(mast, mast_high, neck_d, neck_in):
    return Box(mast, mast, mast_high, align=UP) - Pos(0, 0, mast_high) * Cylinder(neck_d / 2, 2 * neck_in)


def neck(neck_d, neck_long, neck_in):
    return Pos(0, 0, -neck_in) * Cylinder(neck_d / 2, neck_long, align=UP)


def head(head_x, head_y, head_z, neck_d, neck_long, neck_in, play, lens=34, deep=4):
    """Two lenses look to +x."""
    box = Box(head_x, head_y, head_z, align=UP)
    for y in (-1, 1):
        box -= Pos(head_x / 2, y * head_y / 4, head_z / 2) * Rot(0, 90, 0) * Cylinder(lens / 2, 2 * deep)
    return box - Cylinder((neck_d + play) / 2, 2 * (neck_long - neck_in + 2))


def rocker_bolt(side, shank, bolt_head, head_high, rocker_bolt, gap, rocker_thick, air):
    """Its place is on the body's side, y = 0."""
    out = gap + rocker_thick + air
    return across(side, bolt_head, out, out + head_high) + across(side, shank, out + head_high - rocker_bolt, out + 1)


def bogie_bolt(side, shank, bolt_head, head_high, bogie_bolt, bogie_gap, bogie_thick, air):
    """Its place is on the rocker's outer side, y = 0."""
    out = bogie_gap + bogie_thick + air
    return across(side, bolt_head, out, out + head_high) + across(side, shank, out + head_high - bogie_bolt, out + 1)


def swivel(side, start, wheel_y, x, z, boss_high, kingpin_d, play, wide=36):
    """Arm outwards to a boss for a kingpin, whose lower end is at z."""
    arm = Box(wide - 4, wheel_y - start, boss_high - 8)
    solid = Pos(x, side * (start + wheel_y) / 2, z + boss_high / 2) * arm
    solid += Pos(x, side * wheel_y, z) * Cylinder(wide / 2, boss_high, align=UP)
    return solid, Pos(x, side * wheel_y, z) * Cylinder((kingpin_d + play) / 2, 4 * boss_high)


def rocker(
    side,
    shank,
    play,
    gap,
    rocker_thick,
    rocker_x,
    rocker_y,
    rocker_z,
    bogie_x,
    bogie_z,
    wheel_apart,
    wheel_y,
    boss_z,
    boss_high,
    kingpin_d,
    bogie_bolt,
    head_high,
    bogie_gap,
    bogie_thick,
    air,
):
    """About its bolt, from the body's side outwards."""
    low, high = gap, gap + rocker_thick
    front_x, front_z = wheel_apart - rocker_x, boss_z - rocker_z
    back_x, back_z = bogie_x - rocker_x, bogie_z - rocker_z
    solid = across(side, 52, low, high) + across(side, 48, low, high, back_x, back_z)
    solid += bar(side, 40, low, high, back_x, back_z) + bar(side, 27, low, high, front_x, front_z + boss_high / 2)
    arm, hole = swivel(side, low, wheel_y - rocker_y, front_x, front_z, boss_high, kingpin_d, play)
    solid = solid + arm - hole - across(side, shank + play, low - 1, high + 1)
    deep = bogie_bolt - head_high - bogie_gap - bogie_thick - air
    return solid - across(side, shank, high - deep, high + 1, back_x, back_z)


def bogie(
    side,
    shank,
    play,
    bogie_gap,
    bogie_thick,
    bogie_x,
    bogie_y,
    bogie_z,
    axle_z,
    wheel_apart,
    wheel_y,
    boss_z,
    boss_high,
    kingpin_d,
    motor_d,
):
    """About its bolt, from the rocker's outer side outwards."""
    low, high = bogie_gap, bogie_gap + bogie_thick
    middle_x, middle_z = -bogie_x, axle_z - bogie_z
    back_x, back_z = -wheel_apart - bogie_x, boss_z - bogie_z
    solid = across(side, 44, low, high) + across(side, motor_d + 17, low, high, middle_x, middle_z)
    solid += bar(side, 34, low, high, middle_x, middle_z) + bar(side, 27, low, high, back_x, back_z + boss_high / 2)
    arm, hole = swivel(side, low, wheel_y - bogie_y, back_x, back_z, boss_high, kingpin_d, play)
    solid = solid + arm - hole - across(side, shank + play, low - 1, high + 1)
    return solid - across(side, motor_d, low - 1, high + 1, middle_x, middle_z)


def knuckle(side, knuckle_low, knuckle_thick, kingpin_d, motor_d, side_in, bogie_thick, wide=40, eye=54):
    """About the middle of its wheel: a plate above the wheel and one on the inside, with an eye for the motor."""
    high = knuckle_low + knuckle_thick
    inner, outer = -side_in, bogie_thick - side_in
    solid = Pos(0, side * (inner + wide / 2) / 2, knuckle_low) * Box(wide, wide / 2 - inner, knuckle_thick, align=UP)
    solid += Pos(0, side * (inner + outer) / 2, 0) * Box(wide, bogie_thick, high, align=UP)
    solid += across(side, eye, inner, outer)
    solid -= across(side, motor_d, inner - 1, outer + 1)
    return solid - Pos(0, 0, high) * Cylinder(kingpin_d / 2, 4 * knuckle_thick)


def kingpin(kingpin_d, kingpin_long):
    return Cylinder(kingpin_d / 2, kingpin_long, align=UP)


def ring(ring_d, kingpin_d, ring_high):
    return Cylinder(ring_d / 2, ring_high, align=UP) - Cylinder(kingpin_d / 2, 4 * ring_high)


def motor(side, motor_d, motor_long, axle_d, axle_out):
    """Its front face lies in y = 0, its shaft outwards of it."""
    return across(side, motor_d, axle_out - motor_long, 0) + across(side, axle_d, -1, axle_out)


def wheel(side, wheel_d, wheel_wide, axle_d, play, rim=8, web=10, hub=30, hub_long=28):
    """Open outwards; the hub stands on the web at its inner side."""
    inner = -wheel_wide / 2
    solid = across(side, wheel_d, inner, -inner) - across(side, wheel_d - 2 * rim, inner + web, 1 - inner)
    solid += across(side, hub, inner, inner + hub_long)
    return solid - across(side, axle_d + play, inner - 1, 1 - inner)
