from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    shape = Pos(d["left"], d["bottom"], -d["play"]) * Box(d["right"] - d["left"], d["top"] - d["bottom"], d["board"], align=(Align.MIN, Align.MIN, Align.MAX))
    shape += Pos(d["left"], d["bottom"] - d["foot_height"], d["foot_depth"] / 2 - d["play"] - d["board"] / 2) * Box(d["right"] - d["left"], d["foot_height"], d["foot_depth"], align=(Align.MIN, Align.MIN, Align.MAX))
    shape += Pos(0, d["ram_v"] + (d["ram_from"] + d["ram_to"]) / 2, d["ram_w"]) * Rot(X=90) * Cylinder(d["ram_rod_r"], d["ram_to"] - d["ram_from"])
    for end in (d["ram_from"],):
        shape += Pos(0, d["ram_v"] + end, -d["play"] - d["board"] / 2) * Box(1.2 * d["ram_post"], d["ram_post"], d["ram_w"] + d["ram_rod_r"] + 1 + d["play"] + d["board"] / 2, align=LOW)
    shape += Pos(0, 0, -d["play"] - d["board"] / 2) * Cylinder(d["pin_r"], d["o_high"] - (-d["play"] - d["board"] / 2), align=LOW)
    shape += Pos(d["h_u"], d["h_v"], -d["play"] - d["board"] / 2) * Cylinder(d["pin_r"], d["h_high"] - (-d["play"] - d["board"] / 2), align=LOW)
    return FRONT * shape, {
        "ram_guide": {"o": (0, -d["ram_w"], d["ram_v"]), "z": (0, 0, 1), "x": (1, 0, 0)},
        "o": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "h": {"o": (d["h_u"], 0, d["h_v"]), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
