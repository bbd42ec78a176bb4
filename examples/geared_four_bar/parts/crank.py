from math import acos, cos, pi, radians, sin, tan

from build123d import Align, Circle, Cylinder, Polygon, Pos, Rot, extrude

LOW = (Align.CENTER, Align.CENTER, Align.MIN)

PRESSURE = radians(20)


def involute(angle):
    return tan(angle) - angle


def gear_outline(module, teeth, backlash):
    """Points of an involute gear round the origin, one tooth on the x axis."""
    pitch, tip, root = module * teeth / 2, module * (teeth / 2 + 1), module * (teeth / 2 - 1.25)
    base = pitch * cos(PRESSURE)
    half = (pi * module / 2 - backlash / 2) / (2 * pitch) + involute(PRESSURE)  # angle of half a tooth, at the base
    start = max(base, root)
    flank = [(root, half)] if root < base else []  # radial below the base circle
    for i in range(5):
        radius = start + (tip - start) * i / 4
        flank.append((radius, half - involute(acos(min(1, base / radius)))))
    points = []
    for k in range(teeth):
        middle = 2 * pi * k / teeth
        points += [(r * cos(middle - a), r * sin(middle - a)) for r, a in flank]
        points += [(r * cos(middle + a), r * sin(middle + a)) for r, a in reversed(flank)]
    return points


def build(part):
    d = part.dimensions
    length, play, spigot = d["length"], d["play"], d["spigot_length"]
    foot = -d["bearing"] - 1.5 * play  # shoulder below the plate
    high = play / 2 + d["thickness"]
    head = high + d["coupler_thickness"] + 2 * play  # shoulder above the coupler

    outline = Rot(Z=d["phase_deg"]) * Polygon(*gear_outline(d["module"], d["teeth_count"], d["backlash"]), align=None)
    hole = Pos(0.27 * d["module"] * d["teeth_count"], 0) * Circle(d["hole_radius"])
    outline -= [Rot(Z=(i + 0.5) * 360 / d["hole_count"]) * hole for i in range(d["hole_count"])]
    gear = Pos(0, 0, play / 2) * extrude(outline, d["thickness"])

    shaft = Pos(0, 0, foot) * Cylinder(d["shaft_radius"], high - foot, align=LOW)
    shaft += Pos(0, 0, foot - spigot) * Cylinder(d["spigot_radius"], 2 * spigot, align=LOW)
    pin = Cylinder(d["pin_radius"], head - play, align=LOW) + Cylinder(d["spigot_radius"], head - play + spigot, align=LOW)
    gear += [shaft, Pos(length, 0, play) * pin]
    return gear, {
        "axis": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "pin": {"o": (length, 0, high + play / 2), "z": (0, 0, 1), "x": (1, 0, 0)},
        "shaft_end": {"o": (0, 0, foot), "z": (0, 0, -1)},
        "pin_end": {"o": (length, 0, head), "z": (0, 0, 1)},
    }
