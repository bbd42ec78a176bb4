from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    shape = Pos(0, 14, -d["play"]) * Box(2 * d["half"] + 24, 50, d["cheek"], align=(Align.CENTER, Align.MAX, Align.MAX))
    shape += Pos(0, -34, 0) * Box(d["wide"], 8, 90, align=(Align.CENTER, Align.MAX, Align.CENTER))
    shape += Pos(d["half"], 0, -d["play"] - d["cheek"] / 2) * Cylinder(d["pin_r"], d["a_high"] - (-d["play"] - d["cheek"] / 2), align=LOW)
    shape += Pos(-d["half"], 0, -d["play"] - d["cheek"] / 2) * Cylinder(d["pin_r"], d["b_high"] - (-d["play"] - d["cheek"] / 2), align=LOW)
    return FRONT * shape, {
        "a": {"o": (d["half"], 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "b": {"o": (-d["half"], 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
