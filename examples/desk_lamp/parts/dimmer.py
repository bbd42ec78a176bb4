from math import cos, pi, sin

from build123d import Align, Axis, Box, Cylinder, Pos, chamfer

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    radius, height = d["radius"], d["height"]
    knob = Cylinder(radius, height, align=LOW)
    knob = chamfer(knob.edges().sort_by(Axis.Z)[-1], 1.5)
    angles = [2 * pi * (i + 0.5) / d["flute_count"] for i in range(d["flute_count"])]
    knob -= [Pos(radius * cos(angle), radius * sin(angle), 0) * Cylinder(d["flute_radius"], 4 * height) for angle in angles]
    knob -= Pos(radius / 3, 0, height) * Box(radius, d["slot_width"], 2, align=(Align.MIN, Align.CENTER, Align.CENTER))

    foot = -d["bearing"] - 1.5 * d["play"]  # shoulder for the clip, one play below the bearing
    shaft = Pos(0, 0, foot) * Cylinder(d["shaft_radius"], d["play"] / 2 - foot, align=LOW)
    spigot = Pos(0, 0, foot - d["spigot_length"]) * Cylinder(d["spigot_radius"], 2 * d["spigot_length"], align=LOW)
    return Pos(0, 0, d["play"] / 2) * knob + shaft + spigot, {
        "shaft": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "clip": {"o": (0, 0, foot), "z": (0, 0, -1), "x": (1, 0, 0)},
    }
