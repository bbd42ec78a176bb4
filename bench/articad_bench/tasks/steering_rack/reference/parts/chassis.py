from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    shape = Pos(0, (d["back"] + d["front"]) / 2, -d["play"]) * Box(d["wide"], d["front"] - d["back"], d["board"], align=HIGH)
    shape += Pos(0 + (d["rack_bar_from"] + d["rack_bar_to"]) / 2, 0, d["rack_bar_w"]) * Rot(Y=90) * Cylinder(d["rack_bar_rod_r"], d["rack_bar_to"] - d["rack_bar_from"])
    for end in (d["rack_bar_from"], d["rack_bar_to"]):
        shape += Pos(0 + end, 0, -d["play"] - d["board"] / 2) * Box(d["rack_bar_post"], 1.2 * d["rack_bar_post"], d["rack_bar_w"] + d["rack_bar_rod_r"] + 1 + d["play"] + d["board"] / 2, align=LOW)
    shape += Pos(d["k_u"], d["k_v"], -d["play"] - d["board"] / 2) * Cylinder(d["pin_r"], d["k_high"] - (-d["play"] - d["board"] / 2), align=LOW)
    shape += Pos(d["l_u"], d["l_v"], -d["play"] - d["board"] / 2) * Cylinder(d["pin_r"], d["l_high"] - (-d["play"] - d["board"] / 2), align=LOW)
    shape -= Pos(0, d["pinion_v"], 0) * Cylinder(d["column_r"], 3 * d["board"])
    return shape, {
        "rack_bar_guide": {"o": (0, 0, d["rack_bar_w"]), "z": (1, 0, 0), "x": (0, 0, 1)},
        "k": {"o": (d["k_u"], d["k_v"], 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "l": {"o": (d["l_u"], d["l_v"], 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "column": {"o": (0, d["pinion_v"], 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
