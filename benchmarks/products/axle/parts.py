from math import atan2, degrees, hypot

from build123d import *

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def bar(x, y, eye, thick):
    long = hypot(x, y)
    return Rot(Z=degrees(atan2(y, x))) * Pos(long / 2) * Box(long, eye, thick) + Pos(x, y) * Cylinder(eye, thick)


def beam(hw, r, fork, plate=13, deep=40, high=40, web=290, web_thick=18, boss=28):
    body = Box(2 * web, deep, high)
    for side in (-1, 1):
        body += Pos(side * (web + web_thick / 2)) * Box(web_thick, deep, fork + 2 * plate)
        for z in (-(fork + plate) / 2, (fork + plate) / 2):
            body += Pos(side * (web + hw) / 2, 0, z) * Box(hw - web, deep, plate) + Pos(side * hw, 0, z) * Cylinder(boss, plate)
    return Pos(Z=r) * body


def knuckle(side, hw, ax, ay, fork, gap, drag=None, barrel=20, eye=14, thick=20, collar=18, shoulder=54.7):
    body = Cylinder(barrel, fork - 2 * gap) + bar(side * (ax - hw), -ay, eye, thick)
    body += Rot(Y=90 * side) * Cylinder(collar, shoulder, align=LOW)
    return body + bar(0, drag, eye, thick) if drag else body


def hub(radius=30, length=75):
    return Pos(-1) * Rot(Y=-90) * Cylinder(radius, length, align=LOW)


def wheel(r, wide=60, bore=30):
    return Rot(Y=90) * (Cylinder(r, wide) - Cylinder(bore, wide))


def nut(radius=20, thick=14):
    return Rot(Y=-90) * extrude(RegularPolygon(radius, 6), thick)


def tie_rod(length, thick, eye=13):
    return Pos(Z=thick / 2) * (Cylinder(eye, thick) + bar(length, 0, eye, thick))


drag_link = tie_rod


def bracket(wide=40, high=20):
    return Box(wide, wide, high, align=LOW)


def column(drag, eye=14, thick=12, shaft=10, rise=200):
    return Pos(Z=thick / 2) * (Cylinder(eye, thick) + bar(0, drag, eye, thick)) + Cylinder(shaft, rise, align=LOW)
