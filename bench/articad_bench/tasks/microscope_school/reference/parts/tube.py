from build123d import Align, Box, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)
FRONT = (Align.CENTER, Align.MIN, Align.MIN)


def build(part):
    d = part.dimensions
    body = (
        Cylinder(d["tube_radius"], 130, align=LOW)
        + Cylinder(12, 160, align=LOW)
        + Pos(0, 0, 20) * Box(40, d["column_y"] - d["play"], 60, align=FRONT)
        + Pos(0, 0, 1) * Cylinder(d["nose_pin"], 15, align=HIGH)
    )
    body -= Pos(0, d["column_y"] - 5 - d["play"], 0) * Box(d["tongue"] + 2 * d["play"], 40, 200, align=FRONT)
    body -= Pos(0, d["column_y"] - 5 - d["play"], 0) * Box(d["tongue"] + 8 + 2 * d["play"], 2.5 + 2 * d["play"], 200, align=FRONT)

    return body, {"focus": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}, "nosepiece": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
