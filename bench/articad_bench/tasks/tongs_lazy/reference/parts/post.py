from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    shape = Pos(0, d["bottom"], -d["play"]) * Box(d["wide"], d["top"] - d["bottom"], d["board"], align=(Align.CENTER, Align.MIN, Align.MAX))
    shape += Pos(0, 0 + (d["slide_from"] + d["slide_to"]) / 2, d["slide_w"]) * Rot(X=90) * Cylinder(d["slide_rod_r"], d["slide_to"] - d["slide_from"])
    for end in (d["slide_to"],):
        shape += Pos(0, 0 + end, -d["play"] - d["board"] / 2) * Box(1.2 * d["slide_post"], d["slide_post"], d["slide_w"] + d["slide_rod_r"] + 1 + d["play"] + d["board"] / 2, align=LOW)
    shape += Pos(0, 0, -d["play"] - d["board"] / 2) * Cylinder(d["pin_r"], d["b_high"] - (-d["play"] - d["board"] / 2), align=LOW)
    return FRONT * shape, {
        "slide_guide": {"o": (0, -d["slide_w"], 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "b": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
