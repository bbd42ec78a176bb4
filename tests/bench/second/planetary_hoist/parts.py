from math import cos, radians, sin

from build123d import Align, Axis, Cylinder, Pos, chamfer

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def ring(module, ring_count, slack, across, ring_high, gear, under, shaft, play):
    body = Cylinder(across / 2, ring_high, align=DOWN)
    body -= Pos(0, 0, -gear - under) * Cylinder((module * ring_count + slack) / 2, ring_high, align=UP)
    return body - Cylinder(shaft / 2 + play, 3 * ring_high)


def sun(module, sun_count, slack, gear, ring_high, shaft, shaft_low, stub, plate, gap):
    """The disc on its shaft; a stub above it centres the cage."""
    body = Cylinder((module * sun_count - slack) / 2, gear, align=DOWN) + Cylinder(stub / 2, gap + plate, align=UP)
    return chamfer((body + Cylinder(shaft / 2, ring_high + shaft_low, align=DOWN)).edges().sort_by(Axis.Z)[0], 1)


def planet(module, planet_count, slack, gear, pin, play, mark=4):
    body = Cylinder((module * planet_count - slack) / 2, gear, align=DOWN) - Cylinder(pin / 2 + play, 3 * gear)
    return body - Pos(module * planet_count / 2 - 4.2, 0, 0) * Cylinder(mark / 2, 3 * gear)


def cage(orbit, gear, gap, pin, stub, play, cage, plate, drum, drum_high, flange, flange_high):
    body = Cylinder(cage / 2, plate, align=UP) + Cylinder(drum / 2, plate + drum_high, align=UP)
    body += Pos(0, 0, plate + drum_high) * Cylinder(flange / 2, flange_high, align=DOWN)
    for turn in (90, 210, 330):
        body += Pos(orbit * cos(radians(turn)), orbit * sin(radians(turn)), 1) * Cylinder(pin / 2, gap + gear + 1, align=DOWN)
    return body - Cylinder(stub / 2 + play, 2 * plate + 1)
