from build123d import Align, Box, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = (
        Pos(0, 0, d["play"]) * Box(d["plate"], 54, 9, align=LOW)
        - Box(d["tongue"] + 2 * d["play"], 90, 4 + 2 * d["play"], align=LOW)
        + Pos(0, 0, 8) * Box(100, d["tongue"], 5 + d["play"], align=LOW)
        - Pos(0, 0, 2.4 - d["play"]) * Box(d["tongue"] + 8 + 2 * d["play"], 90, 1.6 + 3 * d["play"], align=LOW)
        + Pos(0, 0, 11.4 + d["play"]) * Box(100, d["tongue"] + 8, 1.6, align=LOW)
    )
    return body, {
        "stage_y": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)},
        "stage_x": {"o": (0, 0, 9 + d["play"]), "z": (1, 0, 0), "x": (0, 1, 0)},
    }
