from math import cos, pi, sin

from build123d import Align, Axis, Cylinder, Pos, Rot, chamfer

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    nut = Cylinder(d["radius"], d["length"], align=LOW)
    nut = chamfer(nut.edges().sort_by(Axis.Z)[-1], 1.5)
    angles = [2 * pi * i / d["flute_count"] for i in range(d["flute_count"])]
    nut -= [Pos(d["radius"] * cos(angle), d["radius"] * sin(angle), 0) * Cylinder(d["flute_radius"], 4 * d["length"]) for angle in angles]
    nut -= Cylinder(d["hole_radius"], d["hole_depth"], align=LOW)
    return Rot(X=-90) * nut, {"face": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (0, 0, 1)}}
