from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    shape = Pos(d["left"], d["bottom"], -d["play"]) * Box(d["right"] - d["left"], d["top"] - d["bottom"], d["board"], align=(Align.MIN, Align.MIN, Align.MAX))
    shape += Pos(d["left"], d["bottom"] - d["foot_height"], d["foot_depth"] / 2 - d["play"] - d["board"] / 2) * Box(d["right"] - d["left"], d["foot_height"], d["foot_depth"], align=(Align.MIN, Align.MIN, Align.MAX))
    shape += Pos(0, d["top"] - 1, -d["play"]) * Box(d["post"], -d["top"] + d["head"] + 1, d["board"], align=(Align.CENTER, Align.MIN, Align.MAX))
    shape += Pos(d["left"], d["top"] - 1, -d["play"]) * Box(d["post"], 90, d["board"], align=(Align.MIN, Align.MIN, Align.MAX))
    shape += Pos(d["crosshead_u"], d["crosshead_v"] + (d["crosshead_from"] + d["crosshead_to"]) / 2, d["crosshead_w"]) * Rot(X=90) * Cylinder(d["crosshead_rod_r"], d["crosshead_to"] - d["crosshead_from"])
    for end in (d["crosshead_from"],):
        shape += Pos(d["crosshead_u"], d["crosshead_v"] + end, -d["play"] - d["board"] / 2) * Box(1.2 * d["crosshead_post"], d["crosshead_post"], d["crosshead_w"] + d["crosshead_rod_r"] + 1 + d["play"] + d["board"] / 2, align=LOW)
    shape += Pos(d["s_u"], d["s_v"], -d["play"] - d["board"] / 2) * Cylinder(d["pin_r"], d["s_high"] - (-d["play"] - d["board"] / 2), align=LOW)
    shape += Pos(0, 0, -d["play"] - d["board"] / 2) * Cylinder(d["pin_r"], d["o_high"] - (-d["play"] - d["board"] / 2), align=LOW)
    shape += Pos(0, d["g_v"], -d["play"] - d["board"] / 2) * Cylinder(d["pin_r"], d["g_high"] - (-d["play"] - d["board"] / 2), align=LOW)
    return FRONT * shape, {
        "crosshead_guide": {"o": (d["crosshead_u"], -d["crosshead_w"], d["crosshead_v"]), "z": (0, 0, 1), "x": (1, 0, 0)},
        "s": {"o": (d["s_u"], 0, d["s_v"]), "z": (0, -1, 0), "x": (1, 0, 0)},
        "o": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "g": {"o": (0, 0, d["g_v"]), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
