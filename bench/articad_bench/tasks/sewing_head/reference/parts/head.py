from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    shape = Pos(d["left"], d["bottom"], -d["play"]) * Box(d["right"] - d["left"], d["top"] - d["bottom"], d["board"], align=(Align.MIN, Align.MIN, Align.MAX))
    shape += Pos(d["left"], d["bottom"] - d["foot_height"], d["foot_depth"] / 2 - d["play"] - d["board"] / 2) * Box(d["right"] - d["left"], d["foot_height"], d["foot_depth"], align=(Align.MIN, Align.MIN, Align.MAX))
    shape += Pos(0, d["needle_bar_v"] + (d["needle_bar_from"] + d["needle_bar_to"]) / 2, d["needle_bar_w"]) * Rot(X=90) * Cylinder(d["needle_bar_rod_r"], d["needle_bar_to"] - d["needle_bar_from"])
    for end in (d["needle_bar_from"],):
        shape += Pos(0, d["needle_bar_v"] + end, -d["play"] - d["board"] / 2) * Box(1.2 * d["needle_bar_post"], d["needle_bar_post"], d["needle_bar_w"] + d["needle_bar_rod_r"] + 1 + d["play"] + d["board"] / 2, align=LOW)
    shape += Pos(0, 0, -d["play"] - d["board"] / 2) * Cylinder(d["pin_r"], d["o_high"] - (-d["play"] - d["board"] / 2), align=LOW)
    shape += Pos(d["g_u"], d["g_v"], -d["play"] - d["board"] / 2) * Cylinder(d["pin_r"], d["g_high"] - (-d["play"] - d["board"] / 2), align=LOW)
    return FRONT * shape, {
        "needle_bar_guide": {"o": (0, -d["needle_bar_w"], d["needle_bar_v"]), "z": (0, 0, 1), "x": (1, 0, 0)},
        "o": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "g": {"o": (d["g_u"], 0, d["g_v"]), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
