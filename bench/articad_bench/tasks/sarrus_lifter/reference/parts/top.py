from build123d import Align, Box, Cylinder, Pos, Rot

HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    shape = Pos(0, 0, d["drop"]) * Box(2 * (d["half"] - d["edge"]), 2 * (d["half"] - d["edge"]), d["thick"], align=HIGH)
    for i in range(2):
        for s in (-1, 1):
            shape += Rot(Z=90 * i) * (Pos(d["half"] - d["edge"] / 2 - d["lug"] / 2, s * (d["wide"] / 2 + d["play"] + d["lug"] / 2), d["drop"]) * Box(2 * d["lug"] + d["edge"], d["lug"], d["drop"] + 3, align=HIGH) + Pos(d["half"], s * (d["wide"] / 2 + d["play"] + d["lug"] / 2), 0) * Rot(X=90) * Cylinder(d["lug"] / 2 + 1, d["lug"]))
            shape += Rot(Z=90 * i) * Pos(d["half"], s * (d["wide"] / 2 + d["play"] / 2), 0) * Rot(X=90) * Cylinder(d["pin_r"], d["lug"])
    return shape, {
        "east": {"o": (d["half"], 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "north": {"o": (0, d["half"], 0), "z": (1, 0, 0), "x": (0, 1, 0)},
    }
