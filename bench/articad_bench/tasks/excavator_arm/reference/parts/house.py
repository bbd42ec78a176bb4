from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
CORNER = (Align.MIN, Align.MIN, Align.MIN)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions

    shape = Pos(d["left"], d["bottom"], -d["play"]) * Box(d["right"] - d["left"], d["top"] - d["bottom"], d["board"], align=(Align.MIN, Align.MIN, Align.MAX))
    shape += Pos(d["left"], d["bottom"] - d["deck_h"], -d["play"] - d["board"]) * Box(d["right"] - d["left"], d["deck_h"], d["deck_d"], align=CORNER)

    shape += Pos(0, 0, -d["play"] - d["board"] / 2) * Cylinder(d["pin_r"], d["a_high"] - (-d["play"] - d["board"] / 2), align=LOW)
    shape += Pos(d["p_u"], d["p_v"], -d["play"] - d["board"] / 2) * Cylinder(d["pin_r"], d["p_high"] - (-d["play"] - d["board"] / 2), align=LOW)
    return FRONT * shape, {
        "a": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "p": {"o": (d["p_u"], 0, d["p_v"]), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
