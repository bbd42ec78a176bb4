from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    shape = Pos(d["left"], d["bottom"], -d["play"]) * Box(d["right"] - d["left"], d["top"] - d["bottom"], d["board"], align=(Align.MIN, Align.MIN, Align.MAX))
    shape += Pos(d["left"], d["bottom"] - d["foot_height"], d["foot_depth"] / 2 - d["play"] - d["board"] / 2) * Box(d["right"] - d["left"], d["foot_height"], d["foot_depth"], align=(Align.MIN, Align.MIN, Align.MAX))
    shape += Pos(d["rail_left"], d["top"], -d["play"]) * Box(d["rail_right"] - d["rail_left"], 50, d["board"], align=(Align.MIN, Align.MIN, Align.MAX))
    shape += Pos(d["ram_u"] + (d["ram_from"] + d["ram_to"]) / 2, d["ram_v"], d["ram_w"]) * Rot(Y=90) * Cylinder(d["ram_rod_r"], d["ram_to"] - d["ram_from"])
    for end in (d["ram_from"], d["ram_to"]):
        shape += Pos(d["ram_u"] + end, d["ram_v"], -d["play"] - d["board"] / 2) * Box(d["ram_post"], 1.2 * d["ram_post"], d["ram_w"] + d["ram_rod_r"] + 2 + d["play"] + d["board"] / 2, align=LOW)
    shape += Pos(0, 0, -d["play"] - d["board"] / 2) * Cylinder(d["pin_r"], d["o_high"] - (-d["play"] - d["board"] / 2), align=LOW)
    shape += Pos(0, d["c_v"], -d["play"] - d["board"] / 2) * Cylinder(d["pin_r"], d["c_high"] - (-d["play"] - d["board"] / 2), align=LOW)
    return FRONT * shape, {
        "ram_guide": {"o": (d["ram_u"], -d["ram_w"], d["ram_v"]), "z": (1, 0, 0), "x": (0, -1, 0)},
        "o": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "c": {"o": (0, 0, d["c_v"]), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
