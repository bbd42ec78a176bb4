"""Frame, forks and levers of the practice keyboard; a lever is drawn about its pin and points to the player (-y)."""

from build123d import Align, Axis, Box, Cylinder, GeomType, Pos, Rot, chamfer, fillet

BACK = (Align.CENTER, Align.MIN, Align.MIN)
UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)
NEAR = (Align.CENTER, Align.MAX, Align.CENTER)


def along_x(diameter, long):
    return Rot(0, 90, 0) * Cylinder(diameter / 2, long)


def base(apart, deep, panel):
    return Box(apart, deep, panel, align=BACK)


def panel(side, panel, deep, high):
    """Its inner face lies in x = 0."""
    return Pos(side * panel / 2, 0, 0) * Box(panel, deep, high, align=BACK)


def rail(apart, rail):
    return Box(apart, rail, rail, align=DOWN)


def fork(fork_wide, fork_deep, fork_high, fork_pin, square, pin_d, room=1, base=13):
    body = Box(fork_wide, fork_deep, fork_high, align=UP)
    body -= Pos(0, 0, base) * Box(square + 2 * room, 2 * fork_deep, fork_high, align=UP)
    return body - Pos(0, 0, fork_pin) * along_x(pin_d, 2 * fork_wide)


def pin(pin_d, pin_long, bevel=0.5):
    body = along_x(pin_d, pin_long)
    return chamfer(body.edges().filter_by(GeomType.CIRCLE), bevel)


def natural(long, square, tail, pin_d, play):
    return Pos(0, tail, 0) * Box(square, long, square, align=NEAR) - along_x(pin_d + play, 2 * square)


sharp = natural


def stick(stick_d, stick_long, edge=2):
    """Round stick from the lever's near end, y = 0, its own near end rounded."""
    body = Pos(0, -stick_long / 2, 0) * Rot(90, 0, 0) * Cylinder(stick_d / 2, stick_long)
    return fillet(body.edges().group_by(Axis.Y)[0], edge)
