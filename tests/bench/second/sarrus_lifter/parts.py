"""A plate with two pairs of lugs, in which short pins are pressed; bored leaves. At the knee a low leaf has two eyes, a high one an eye with journals."""

from build123d import Align, Axis, Box, Circle, Cylinder, Pos, Rectangle, Rot, chamfer, extrude

LOW = (Align.MIN, Align.MIN, Align.MIN)


def along_y(radius, long, x=0, y=0):
    return Pos(x, y, 0) * Rot(90, 0, 0) * Cylinder(radius, long)


def lugs(plate, hinge_at, hinge_z, knuckle, wide, pin_d, air, lug, thick):
    """The two lugs of the east side."""
    flat = Pos((hinge_at + plate) / 2 - 5, thick / 2) * Rectangle(hinge_at - plate + 10, thick) + Pos(hinge_at, hinge_z) * Circle(knuckle / 2 - 0.5)
    one = Rot(90, 0, 0) * extrude(flat, lug / 2, both=True)
    place = wide / 2 + air + lug / 2
    pins = []
    for side in (-1, 1):
        stub = along_y(pin_d / 2, lug + 2 * 8, hinge_at, 0)
        stub = stub - Pos(hinge_at, side * lug / 2, 0) * Box(40, 16, 40, align=(Align.CENTER, Align.MIN if side > 0 else Align.MAX, Align.CENTER))
        pins.append(Pos(0, plate / 2 + side * place, 0) * (one + Pos(0, 0, hinge_z) * stub))
    return pins


def base(plate, hinge_at, hinge_z, knuckle, wide, pin_d, air, lug, thick=6):
    body = Box(plate, plate, thick, align=LOW)
    body = chamfer(body.edges().group_by(Axis.X)[0].filter_by(Axis.Z), 2)
    for one in lugs(plate, hinge_at, hinge_z, knuckle, wide, pin_d, air, lug, thick):
        body += one
        body += Pos(plate / 2, plate / 2, 0) * Rot(0, 0, 90) * Pos(-plate / 2, -plate / 2, 0) * one
    return body


top = base


def leaf(leaf, knuckle, wide, pin_d, play, thick, end):
    """A plate that ends before the knee, with a bored knuckle about the origin."""
    body = Box(leaf - end, wide, thick, align=(Align.MIN, Align.CENTER, Align.CENTER)) + along_y(knuckle / 2, wide)
    return body - along_y(pin_d / 2 + play, 2 * wide)


def low(leaf_, knuckle, wide, pin_d, play, air, thick=5, end=12, eye=15):
    body = leaf(leaf_, knuckle, wide, pin_d, play, thick, end)
    cheek = (wide - eye) / 2 - air
    for side in (-1, 1):
        y = side * (wide - cheek) / 2
        body += Pos(leaf_ - end - 1, y, 0) * Box(end + 1, cheek, thick, align=(Align.MIN, Align.CENTER, Align.CENTER)) + along_y(knuckle / 2, cheek, leaf_, y)
    return body - along_y(pin_d / 2 + play, 2 * wide, leaf_)


def high(leaf_, knuckle, wide, pin_d, play, thick=5, end=12, eye=15):
    body = leaf(leaf_, knuckle, wide, pin_d, play, thick, end)
    body += Pos(leaf_ - end - 1, 0, 0) * Box(end + 1, eye, thick, align=(Align.MIN, Align.CENTER, Align.CENTER)) + along_y(knuckle / 2, eye, leaf_)
    return body + along_y(pin_d / 2, wide, leaf_)


def east_low(leaf, knuckle, wide, pin_d, play, air):
    return low(leaf, knuckle, wide, pin_d, play, air)


def east_high(leaf, knuckle, wide, pin_d, play):
    return high(leaf, knuckle, wide, pin_d, play)


def north_low(leaf, knuckle, wide, pin_d, play, air):
    return Rot(0, 0, 90) * low(leaf, knuckle, wide, pin_d, play, air)


def north_high(leaf, knuckle, wide, pin_d, play):
    return Rot(0, 0, 90) * high(leaf, knuckle, wide, pin_d, play)
