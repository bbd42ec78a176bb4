from math import cos, radians, sin

from build123d import Align, Box, Circle, Cylinder, Pos, Rectangle, Rot, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)
BACK = (Align.CENTER, Align.MIN, Align.CENTER)
RIGHT = (Align.MIN, Align.CENTER, Align.CENTER)


def along_y(x, z, start, end, radius):
    return Pos(x, start, z) * Rot(X=-90) * Cylinder(radius, end - start, align=UP)


def body(wide, deep, high, door_t, gap, hinge_x, hinge_y, ear, pin_d, wall=15, lip=12, open_x=240, open_z=200):
    """A box whose front has an opening with a lip; at the left edge an ear above and below the door."""
    shell = Pos(0, 0, high / 2) * Box(wide, deep, high, align=BACK)
    shell -= Pos(0, lip, high / 2) * Box(wide - 2 * wall, deep - lip - wall, high - 2 * wall, align=BACK)
    shell -= Pos(0, -1, high / 2) * Box(open_x, 2 * lip + 2, open_z, align=BACK)
    outline = (
        Circle(door_t / 2)
        + Pos(9, 0) * Rectangle(18, door_t)
        + Pos(18 - (18 + door_t / 2) / 2, -hinge_y / 2 + 1) * Rectangle(18 + door_t / 2, -hinge_y + 2)
    )
    for z in (0, high - ear):
        shell += Pos(hinge_x, hinge_y, z) * extrude(outline, ear)
    return shell - Pos(hinge_x, hinge_y, 0) * Cylinder(pin_d / 2, 4 * high)


def pin(ear, pin_d, into=18):
    return Cylinder(pin_d / 2, ear + into, align=UP)


def door(
    wide,
    high,
    door_t,
    gap,
    hinge_x,
    hinge_y,
    ear,
    pin_d,
    play,
    handle_x,
    handle_z,
    dial_x,
    dial_z,
    spindle_d,
    bolt_y,
    bolt_z,
    bolt_wide,
    bolt_thick,
    into=20,
):
    """About the pins' axis, its hinge edge round; guides for the bolts are on its back."""
    long = wide / 2 - hinge_x
    outline = Circle(door_t / 2) + Pos(long / 2, 0) * Rectangle(long, door_t)
    low = ear + 0.5
    plate = Pos(0, 0, low) * extrude(outline, high - 2 * low)
    for z in (ear, high - ear):
        plate -= Pos(0, 0, z) * Cylinder(pin_d / 2 + play, 2 * into)
    plate -= along_y(handle_x - hinge_x, handle_z, -door_t, door_t, spindle_d / 2 + play)
    plate -= along_y(dial_x - hinge_x, dial_z, -door_t, door_t, spindle_d / 2 + play)
    back = bolt_y - hinge_y
    for side in (-1, 1):
        at = Pos(30 - hinge_x, 0, high / 2 + side * bolt_z)
        top = back + bolt_thick / 2 + 5
        plate += at * Pos(32, door_t / 2 - 1, 0) * Box(64, top - door_t / 2 + 1, bolt_wide + 12, align=BACK)
        plate -= at * Pos(32, back, 0) * Box(80, bolt_thick + 2 * play, bolt_wide + 2 * play)
    return plate


def bolt(bolt_wide, bolt_thick, tip=112):
    return Box(tip, bolt_thick, bolt_wide, align=RIGHT)


def turned(door_t, gap, spindle_d, hub_d, hub):
    """Hub before the door, spindle through it, disc behind it; the door's front is y = 0."""
    rod = along_y(0, 0, -1, door_t + 7, spindle_d / 2) + along_y(0, 0, door_t + gap, door_t + 7, spindle_d / 2 + 6)
    return rod + along_y(0, 0, -hub, -gap, hub_d / 2)


def dial(door_t, gap, spindle_d, across=64, high=20):
    """A knob with grip notches and a groove that marks its zero."""
    body = turned(door_t, gap, spindle_d, across, high)
    for i in range(18):
        a = radians(20 * i)
        body -= along_y(across / 2 * cos(a), across / 2 * sin(a), -high, -high + 12, 2)
    return body - Pos(0, -high, across / 2 - 8) * Box(1.5, 2, 10)


def handle(door_t, gap, spindle_d, front, long=88, bar=16, thick=12):
    """A lever along +x."""
    reach = front - gap - door_t
    body = turned(door_t, gap, spindle_d, 30, reach)
    body += Pos(0, -reach + thick / 2, 0) * Box(long, thick, bar, align=RIGHT)
    return body + along_y(long, 0, -reach, -reach + thick, bar / 2)
