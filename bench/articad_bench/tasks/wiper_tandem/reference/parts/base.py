from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    shape = Pos(d["left"], d["bottom"], -d["play"]) * Box(d["right"] - d["left"], d["top"] - d["bottom"], d["board"], align=(Align.MIN, Align.MIN, Align.MAX))
    shape += Pos(d["q_u"], d["q_v"], -d["play"]) * Box(d["plate"], d["plate"], d["board"], align=HIGH) + Pos(d["q_u"], d["q_v"] / 2, -d["play"]) * Box(d["plate"], -d["q_v"], d["board"], align=HIGH)
    shape += Pos(d["q_u"], d["q_v"], -d["play"] - d["board"] / 2) * Cylinder(d["pin_r"], d["q_high"] - (-d["play"] - d["board"] / 2), align=LOW)
    shape += Pos(0, 0, -d["play"] - d["board"] / 2) * Cylinder(d["pin_r"], d["l_high"] - (-d["play"] - d["board"] / 2), align=LOW)
    shape += Pos(d["r_u"], 0, -d["play"] - d["board"] / 2) * Cylinder(d["pin_r"], d["r_high"] - (-d["play"] - d["board"] / 2), align=LOW)
    return FRONT * shape, {
        "q": {"o": (d["q_u"], 0, d["q_v"]), "z": (0, -1, 0), "x": (1, 0, 0)},
        "l": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "r": {"o": (d["r_u"], 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
