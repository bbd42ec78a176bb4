from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
CORNER = (Align.MIN, Align.MIN, Align.MIN)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    shape = Pos(d["left"], -d["height"] / 2, -d["play"] - d["deep"]) * Box(d["wide"], d["height"], d["deep"], align=CORNER)
    shape -= Pos(d["left"] + d["wall"], -d["height"] / 2 + d["wall"], -d["play"] - d["deep"] + d["wall"]) * Box(d["wide"] - 2 * d["wall"], d["height"], d["deep"] - 2 * d["wall"], align=CORNER)
    shape += Pos(0, 0, -d["play"] - d["wall"]) * Cylinder(d["pin_r"], d["pin_top"] + d["play"] + d["wall"], align=LOW)
    shape += Pos(35, 0, -d["play"] - d["wall"]) * Cylinder(d["pin_r"], d["pin_top"] + d["play"] + d["wall"], align=LOW)
    return FRONT * shape, {
        "e": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "f": {"o": (35, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
