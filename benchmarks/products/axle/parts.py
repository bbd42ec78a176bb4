from math import atan2, degrees, hypot

from build123d import Align, Box, Cylinder, Pos, RegularPolygon, Rot, extrude


def disc(d, up):
    return Pos(Z=up * d.thick / 2) * Cylinder(d.radius, d.thick)


def link(d):
    ends = Cylinder(d.eye, d.thick) + Pos(d.length) * Cylinder(d.eye, d.thick)
    return Pos(Z=d.thick / 2) * (Pos(d.length / 2) * Box(d.length, d.wide, d.thick) + ends)


def beam(d):
    body = Box(2 * d.web, d.deep, d.high)
    reach = d.hw - d.web
    for side in (-1, 1):
        body += Pos(side * (d.web + d.web_thick / 2)) * Box(d.web_thick, d.deep, d.fork + 2 * d.plate)
        for z in (-(d.fork + d.plate) / 2, (d.fork + d.plate) / 2):
            body += Pos(side * (d.web + reach / 2), 0, z) * Box(reach, d.deep, d.plate)
            body += Pos(side * d.hw, 0, z) * Cylinder(d.boss, d.plate)
    return Pos(Z=d.zc) * body


def arm(x, y, d):
    long = hypot(x, y)
    bar = Pos(long / 2) * Box(long, 0.8 * d.eye, d.thick)
    return Rot(Z=degrees(atan2(y, x))) * bar + Pos(x, y) * Cylinder(d.eye, d.thick)


def knuckle(d):
    body = Cylinder(d.barrel, d.high) + arm(-d.side * d.ax, -d.ay, d)
    body += Rot(Y=90 * d.side) * Cylinder(d.collar, d.shoulder, align=(Align.CENTER, Align.CENTER, Align.MIN))
    return body + arm(0, d.drag, d) if "drag" in d else body


def column(d):
    body = Cylinder(d.eye, d.thick) + Pos(0, d.arm / 2) * Box(d.eye, d.arm, d.thick)
    body += Pos(0, d.arm) * Cylinder(d.eye, d.thick) + Pos(Z=d.rise / 2) * Cylinder(d.shaft, d.rise)
    return Pos(Z=d.thick / 2) * body


def build(part):
    d = part.dimensions
    match part.name:
        case "beam":
            shape = beam(d)
        case "bracket":
            shape = Pos(Z=d.high / 2) * Box(d.wide, d.wide, d.high)
        case "column":
            shape = column(d)
        case "hub_l":
            shape = Pos(-d.length / 2) * Rot(Y=90) * Cylinder(d.radius, d.length)
        case "kingpin_l":
            shape = disc(d, 1)
        case "knuckle_l" | "knuckle_r":
            shape = knuckle(d)
        case "nut_l":
            shape = Rot(Y=-90) * extrude(RegularPolygon(d.radius, 6), d.thick)
        case "tie_rod" | "drag_link":
            shape = link(d)
        case "wheel_l":
            shape = Rot(Y=90) * (Cylinder(d.radius, d.wide) - Cylinder(d.bore, 2 * d.wide))
        case _:
            shape = disc(d, -1)
    return part.made(shape)
