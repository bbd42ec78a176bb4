from build123d import Align, Box, Cylinder, PolarLocations, Pos, Rot, Sphere

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def body(wide, deep, tall, leg_x, bar_d, push, play, collar_d, collar, roof, short_z, dial_d, dial, axle_d, dial_y, dial_z, pitch, air):
    """Block with a stepped bore for the long leg, a blind one for the short leg, three windows and an axle through them."""
    block = Box(wide, deep, tall, align=UP)
    block -= Pos(-leg_x, 0, tall - roof - push - collar - 4 * air) * Cylinder(collar_d / 2 + play, push + collar + 4 * air, align=UP)
    block -= Pos(-leg_x, 0, tall - roof - 1) * Cylinder(bar_d / 2 + play, 2 * roof, align=UP)
    block -= Pos(leg_x, 0, short_z - push - 2) * Cylinder(bar_d / 2 + play, push + 4, align=UP)
    room = dial_d / 2 + 0.5
    for k in range(3):
        window = Pos(0, dial_y, 0) * Cylinder(room, dial + 2 * air) + Pos(0, dial_y - deep / 2, 0) * Box(2 * room, deep, dial + 2 * air)
        block -= Pos(0, 0, dial_z + k * pitch) * window
    return block + Pos(0, dial_y, dial_z - dial) * Cylinder(axle_d / 2, 2 * pitch + 2 * dial, align=UP)


def shackle(tall, leg_x, bar_d, top, roof, collar_d, collar, short_z, air):
    """About the long leg; z = 0 is the body's upper face."""
    high, across, low = top - tall - bar_d / 2, 2 * leg_x, -roof - air - collar
    bow = Pos(0, 0, low) * Cylinder(bar_d / 2, high - low, align=UP) + Pos(0, 0, low) * Cylinder(collar_d / 2, collar, align=UP)
    bow += Pos(across, 0, high) * Cylinder(bar_d / 2, high - (short_z - tall), align=DOWN)
    bow += Pos(0, 0, high) * Rot(Y=90) * Cylinder(bar_d / 2, across, align=UP)
    return bow + Pos(0, 0, high) * Sphere(bar_d / 2) + Pos(across, 0, high) * Sphere(bar_d / 2)


def dial(dial_d, dial, axle_d, play):
    ring = Cylinder(dial_d / 2, dial) - Cylinder(axle_d / 2 + play, 2 * dial)
    for place in PolarLocations(dial_d / 2, 10):
        ring -= place * Cylinder(0.8, 2 * dial)
    return ring
