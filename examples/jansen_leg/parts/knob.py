from math import cos, pi, sin

from build123d import Align, Axis, Cylinder, Pos, Rot, chamfer

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    radius, grip = d["radius"], d["length"] - d["neck_length"]
    knob = Cylinder(radius, grip, align=LOW)
    knob = Pos(0, 0, d["neck_length"]) * chamfer(knob.edges().group_by(Axis.Z)[0] + knob.edges().group_by(Axis.Z)[-1], 1.5)
    angles = [2 * pi * i / d["flute_count"] for i in range(d["flute_count"])]
    knob -= [Pos(radius * cos(angle), radius * sin(angle), d["length"]) * Cylinder(d["flute_radius"], 4 * grip) for angle in angles]
    knob += Cylinder(d["neck_radius"], d["neck_length"], align=LOW)
    knob -= Cylinder(d["hole_radius"], d["hole_depth"], align=LOW)
    return Rot(X=-90) * knob, {"face": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (0, 0, 1)}}
