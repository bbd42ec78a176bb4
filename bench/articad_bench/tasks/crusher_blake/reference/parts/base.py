from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    shape = Pos(d["left"], d["bottom"], -d["play"]) * Box(d["right"] - d["left"], d["top"] - d["bottom"], d["board"], align=(Align.MIN, Align.MIN, Align.MAX))
    shape += Pos(d["left"], d["bottom"] - d["foot_height"], d["foot_depth"] / 2 - d["play"] - d["board"] / 2) * Box(d["right"] - d["left"], d["foot_height"], d["foot_depth"], align=(Align.MIN, Align.MIN, Align.MAX))
    shape += Pos(0, 0, -d["play"] - d["board"] / 2) * Cylinder(d["pin_r"], d["o_high"] - (-d["play"] - d["board"] / 2), align=LOW)
    shape += Pos(d["e_u"], d["e_v"], -d["play"] - d["board"] / 2) * Cylinder(d["pin_r"], d["e_high"] - (-d["play"] - d["board"] / 2), align=LOW)
    shape += Pos(d["j_u"], d["j_v"], -d["play"] - d["board"] / 2) * Cylinder(d["pin_r"], d["j_high"] - (-d["play"] - d["board"] / 2), align=LOW)
    return FRONT * shape, {
        "o": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "e": {"o": (d["e_u"], 0, d["e_v"]), "z": (0, -1, 0), "x": (1, 0, 0)},
        "j": {"o": (d["j_u"], 0, d["j_v"]), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
