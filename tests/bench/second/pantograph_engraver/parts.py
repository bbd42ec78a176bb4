"""Lower bars carry pins upwards with a washer face of 0.2 mm, upper bars are bored."""

from build123d import Align, Axis, Box, Circle, Cone, Cylinder, Pos, SlotCenterToCenter, chamfer, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def strip(long, wide, thick, bores, radius):
    flat = Pos(long / 2, 0) * SlotCenterToCenter(long, wide)
    for x in bores:
        flat -= Pos(x, 0) * Circle(radius)
    return extrude(flat, thick)


def pin(x, thick, air, pin_d):
    stud = Pos(x, 0, thick / 2) * Cylinder(pin_d / 2, thick / 2 + air + thick + 1, align=UP)
    return chamfer(stud.edges().group_by(Axis.Z)[-1], 0.5) + Pos(x, 0, thick - 1) * Cylinder(pin_d / 2 + 2, 1 + air / 2, align=UP)


def point(x, top, down, radius=4):
    """A stylus that hangs down to `down` from inside of a bar."""
    return Pos(x, 0, top) * Cylinder(radius, top - down - 6, align=DOWN) + Pos(x, 0, down) * Cone(1, radius, 6, align=UP)


def table(low, thick, pin_d, table, side, deep=360):
    long = 4 * side + 80
    top = Box(long, deep, table, align=(Align.MIN, Align.CENTER, Align.MAX)).moved(Pos(-60, 0, 0))
    top = chamfer(top.edges().filter_by(Axis.Z), 3)
    post = Pos(0, 0, -table / 2) * Cylinder(10, table / 2 + low - 0.2, align=UP)
    stud = Cylinder(pin_d / 2, low + thick + 1, align=UP)
    return top + post + chamfer(stud.edges().group_by(Axis.Z)[-1], 0.5)


def first_long(side, wide, thick, air, pin_d, play):
    bar = strip(2 * side, wide, thick, [0], pin_d / 2 + play)
    return bar + pin(side, thick, air, pin_d) + pin(2 * side, thick, air, pin_d)


def second_long(side, wide, thick, high, pin_d, play):
    return strip(2 * side, wide, thick, [0, side], pin_d / 2 + play) + point(2 * side, thick / 2, 0.5 - high)


def first_short(side, wide, thick, pin_d, play):
    return strip(side, wide, thick, [0, side], pin_d / 2 + play)


def second_short(side, wide, thick, low, air, pin_d):
    bar = strip(side, wide, thick, [], 1)
    return bar + pin(0, thick, air, pin_d) + pin(side, thick, air, pin_d) + point(0, thick / 2, 0.5 - low)
