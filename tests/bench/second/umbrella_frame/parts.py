"""Layers across a sector, from -y to y: the crown's ear, the rib about y = 0, the stretcher; the runner's ear is about y = 0 too."""

from math import cos, radians, sin

from build123d import Align, Circle, Cylinder, Pos, Rectangle, Rot, SlotCenterToCenter, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def across(flat, low, high):
    """A shape in XZ from y = low to high."""
    return Pos(0, high, 0) * Rot(90, 0, 0) * extrude(flat, high - low)


def pin(x, z, radius, low, high):
    return across(Pos(x, z) * Circle(radius), low, high)


def stick(stick_d, hub_d, crown_z, near, wide, thick, air, pin_d, tall=400, handle_d=25, handle=42):
    """Stick with handle and crown; eight ears with pins carry the ribs."""
    body = Cylinder(stick_d / 2, tall, align=UP) + Cylinder(handle_d / 2, handle, align=UP)
    body += Pos(0, 0, crown_z) * Cylinder(hub_d / 2, wide)
    ear = Pos(near, 0) * Circle(wide / 2) + Pos(near / 2 + 2, 0) * Rectangle(near - 4, wide)
    face = -thick / 2 - air
    for turn in range(0, 360, 45):
        one = across(ear, face - thick, face) + pin(near, 0, pin_d / 2, face - thick / 2, thick / 2)
        body += Pos(0, 0, crown_z) * Rot(0, 0, turn) * one
    return body


def runner(stick_d, hub_d, play, near, wide, thick, air, pin_d, below=30):
    """A sleeve; eight ears with pins carry the stretchers."""
    body = Pos(0, 0, wide / 2) * Cylinder(hub_d / 2, below + wide / 2, align=DOWN)
    ear = Pos(near, 0) * Circle(wide / 2) + Pos(near / 2 + 2, 0) * Rectangle(near - 4, wide)
    for turn in range(0, 360, 45):
        body += Rot(0, 0, turn) * (across(ear, -thick / 2, thick / 2) + pin(near, 0, pin_d / 2, 0, thick * 1.5 + air))
    return body - Cylinder(stick_d / 2 + play, 4 * below)


def bar(long, lean, near, wide):
    middle = Pos(near + long / 2 * cos(radians(lean)), -long / 2 * sin(radians(lean)))
    return middle * Rot(0, 0, -lean) * SlotCenterToCenter(long, wide)


def rib(rib, arm, lean, near, wide, thick, air, pin_d, pin_play):
    """From the crown downwards, with the stretcher's pin at arm."""
    flat = bar(rib, lean, near, wide) - Pos(near, 0) * Circle(pin_d / 2 + pin_play)
    x, z = near + arm * cos(radians(lean)), -arm * sin(radians(lean))
    return across(flat, -thick / 2, thick / 2) + pin(x, z, pin_d / 2, 0, thick * 1.5 + air)


def stretcher(arm, lean, near, wide, thick, air, pin_d, pin_play):
    """From the runner upwards to the rib."""
    flat = bar(arm, -lean, near, wide) - Pos(near, 0) * Circle(pin_d / 2 + pin_play)
    flat -= Pos(near + arm * cos(radians(lean)), arm * sin(radians(lean))) * Circle(pin_d / 2 + pin_play)
    return across(flat, thick / 2 + air, thick * 1.5 + air)
