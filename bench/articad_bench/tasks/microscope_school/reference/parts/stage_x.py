from build123d import Align, Box, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = (
        Pos(0, 0, d["play"]) * Box(d["plate"], 50, 9, align=LOW)
        - Box(200, d["tongue"] + 2 * d["play"], 4 + 2 * d["play"], align=LOW)
        - Pos(0, 0, 2.4 - d["play"]) * Box(200, d["tongue"] + 8 + 2 * d["play"], 1.6 + 3 * d["play"], align=LOW)
    )
    return body, {"stage_x": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}}
