from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
CORNER = (Align.MIN, Align.MIN, Align.MIN)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    shape = Pos(-d["half"], -d["height"], -d["play"] - d["deep"]) * Box(2 * d["half"], d["height"], d["deep"], align=CORNER)
    shape -= Pos(-d["half"] + d["wall"], -d["height"] + d["wall"], -d["play"] - d["deep"] + d["wall"]) * Box(2 * d["half"] - 2 * d["wall"], d["height"], d["deep"] - 2 * d["wall"], align=CORNER)
    shape += Pos(d["a_u"], d["a_v"], -d["play"] - d["wall"]) * Cylinder(d["pin_r"], d["pin_top"] + d["play"] + d["wall"], align=LOW)
    shape += Pos(d["b_u"], d["b_v"], -d["play"] - d["wall"]) * Cylinder(d["pin_r"], d["pin_top"] + d["play"] + d["wall"], align=LOW)
    shape += Pos(-d["a_u"], d["a_v"], -d["play"] - d["wall"]) * Cylinder(d["pin_r"], d["pin_top"] + d["play"] + d["wall"], align=LOW)
    shape += Pos(-d["b_u"], d["b_v"], -d["play"] - d["wall"]) * Cylinder(d["pin_r"], d["pin_top"] + d["play"] + d["wall"], align=LOW)
    return FRONT * shape, {
        "a": {"o": (d["a_u"], 0, d["a_v"]), "z": (0, -1, 0), "x": (1, 0, 0)},
        "b": {"o": (d["b_u"], 0, d["b_v"]), "z": (0, -1, 0), "x": (1, 0, 0)},
        "a_left": {"o": (-d["a_u"], 0, d["a_v"]), "z": (0, -1, 0), "x": (-1, 0, 0)},
        "b_left": {"o": (-d["b_u"], 0, d["b_v"]), "z": (0, -1, 0), "x": (-1, 0, 0)},
    }
