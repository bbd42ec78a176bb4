from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    shape = Pos(0, d["bottom"], -d["play"]) * Box(2 * d["half_w"], d["top"] - d["bottom"], d["board"], align=(Align.CENTER, Align.MIN, Align.MAX))
    shape += Pos(0, d["bottom"] + 2, -d["play"] - d["board"] / 2) * Rot(X=90) * Cylinder(d["flange_r"], 12, align=LOW)
    shape += Pos(d["a_u"], 0, -d["play"] - d["board"] / 2) * Cylinder(d["pin_r"], d["a_high"] - (-d["play"] - d["board"] / 2), align=LOW)
    shape += Pos(d["b_u"], 0, -d["play"] - d["board"] / 2) * Cylinder(d["pin_r"], d["b_high"] - (-d["play"] - d["board"] / 2), align=LOW)
    shape += Pos(d["c_u"], d["c_v"], -d["play"] - d["board"] / 2) * Cylinder(d["pin_r"], d["c_high"] - (-d["play"] - d["board"] / 2), align=LOW)
    shape += Pos(d["d_u"], d["d_v"], -d["play"] - d["board"] / 2) * Cylinder(d["pin_r"], d["d_high"] - (-d["play"] - d["board"] / 2), align=LOW)
    return FRONT * shape, {
        "a": {"o": (d["a_u"], 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "b": {"o": (d["b_u"], 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "c": {"o": (d["c_u"], 0, d["c_v"]), "z": (0, -1, 0), "x": (1, 0, 0)},
        "d": {"o": (d["d_u"], 0, d["d_v"]), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
