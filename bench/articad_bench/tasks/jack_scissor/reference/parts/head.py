from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    shape = Pos(0, -14, -d["play"]) * Box(2 * d["half"] + 24, 40, d["cheek"], align=(Align.CENTER, Align.MIN, Align.MAX))
    shape += Pos(0, 24, 0) * Box(d["wide"], 8, 50, align=(Align.CENTER, Align.MIN, Align.CENTER))
    shape += Pos(d["half"], 0, -d["play"] - d["cheek"] / 2) * Cylinder(d["pin_r"], d["c_high"] - (-d["play"] - d["cheek"] / 2), align=LOW)
    shape += Pos(-d["half"], 0, -d["play"] - d["cheek"] / 2) * Cylinder(d["pin_r"], d["d_high"] - (-d["play"] - d["cheek"] / 2), align=LOW)
    return FRONT * shape, {
        "c": {"o": (d["half"], 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "d": {"o": (-d["half"], 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
