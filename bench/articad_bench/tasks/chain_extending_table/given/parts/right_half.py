from build123d import Align, Box, Pos

LEFT_LOW = (Align.MIN, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(1, 0, 20 + d["play"]) * Box(d["length"] / 2 - 1, d["width"], d["top"], align=LEFT_LOW)
    for side in (-1, 1):
        body += Pos(1, side * 313, d["play"]) * (
            Box(430, 70, 21, align=LEFT_LOW) - Pos(-5, 0, -1) * Box(900, d["rail"] + 2 * d["play"], 13 + d["play"], align=LEFT_LOW)
        )

    return body, {"right": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}}
