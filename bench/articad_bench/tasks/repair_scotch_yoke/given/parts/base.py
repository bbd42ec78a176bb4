from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    shape = Pos(-d["half_w"], -d["half_h"] - d["stand"], -d["play"]) * Box(2 * d["half_w"], 2 * d["half_h"] + d["stand"], d["board"], align=(Align.MIN, Align.MIN, Align.MAX))
    shape += Pos(0, -d["half_h"] - d["stand"], 20) * Box(2 * d["half_w"], d["stand"], 70)
    for v in (-d["rod_v"], d["rod_v"]):
        shape += Pos(0, v, d["rod_out"]) * Rot(Y=90) * Cylinder(d["rod_r"], 2 * d["half_w"] - d["post"])
        for u in (-d["half_w"] + d["post"] / 2, d["half_w"] - d["post"] / 2):
            shape += Pos(u, v, -d["play"] - d["board"] / 2) * Box(d["post"], 2 * d["post"], d["rod_out"] + 2 * d["rod_r"] + d["board"] / 2, align=LOW)
    shape += Pos(0, 0, -d["play"] - d["board"] / 2) * Cylinder(d["shaft_r"], d["shaft_top"] + d["play"] + d["board"] / 2, align=LOW)
    return FRONT * shape, {
        "rails": {"o": (0, -d["rod_out"], 0), "z": (1, 0, 0), "x": (0, -1, 0)},
        "shaft": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
