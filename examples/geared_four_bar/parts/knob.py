from math import cos, pi, sin

from build123d import Align, Axis, Cylinder, Pos, chamfer

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    radius = d["radius"]
    knob = Cylinder(radius, d["height"], align=LOW)
    knob = chamfer(knob.edges().sort_by(Axis.Z)[-1], 1.5)
    angles = [2 * pi * i / d["flute_count"] for i in range(d["flute_count"])]
    knob -= [Pos(radius * cos(angle), radius * sin(angle), 0) * Cylinder(d["flute_radius"], 4 * d["height"]) for angle in angles]
    return knob - Cylinder(d["hole_radius"], d["hole_depth"], align=LOW), {"face": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
