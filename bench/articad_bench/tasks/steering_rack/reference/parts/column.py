from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    shape = Pos(0, 0, d["low"]) * Cylinder(d["pinion"], d["thickness"], align=LOW) + Pos(0, 0, d["low"]) * Cylinder(d["shaft_r"], d["shaft"], align=LOW) + Pos(0, 0, d["low"] + d["shaft"]) * Cylinder(d["wheel_r"], 8, align=LOW)
    journal = d["board"] + d["play"]
    shape += Pos(0, 0, -journal) * Cylinder(d["shaft_r"] - 2, journal + d["low"] + 1, align=LOW)
    return shape, {
        "shaft": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
