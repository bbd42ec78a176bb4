from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    shape = Pos(0, 0, -d["play"] - d["board"]) * Cylinder(d["bore"] + d["wall"], d["board"] + d["play"] + d["thickness"], align=LOW)
    shape -= Pos(0, 0, -d["play"]) * Cylinder(d["bore"], 1000, align=LOW) + Pos(0, 0, -2 * d["board"]) * Cylinder(d["hole_r"], 1000, align=LOW)
    return shape, {
        "o": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
