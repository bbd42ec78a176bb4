from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    shape = Pos(0, d["beam"], -d["play"]) * Box(2 * d["half"], d["beam_h"], d["board"], align=(Align.CENTER, Align.MIN, Align.MAX))
    for side in (-1, 1):
        shape += Pos(side * (d["half"] - d["bracket"] / 2 - 6), -d["drop"], -d["play"]) * Box(d["bracket"], d["beam"] + d["drop"] + 1, d["board"], align=(Align.CENTER, Align.MIN, Align.MAX))
    shape += Pos(d["a_u"], d["a_v"], -d["play"] - d["board"] / 2) * Cylinder(d["pin_r"], d["a_high"] - (-d["play"] - d["board"] / 2), align=LOW)
    shape += Pos(d["b_u"], d["b_v"], -d["play"] - d["board"] / 2) * Cylinder(d["pin_r"], d["b_high"] - (-d["play"] - d["board"] / 2), align=LOW)
    return FRONT * shape, {
        "a": {"o": (d["a_u"], 0, d["a_v"]), "z": (0, -1, 0), "x": (1, 0, 0)},
        "b": {"o": (d["b_u"], 0, d["b_v"]), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
