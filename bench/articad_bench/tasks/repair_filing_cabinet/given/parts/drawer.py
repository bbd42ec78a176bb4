from build123d import Align, Box, Pos

FRONT = (Align.CENTER, Align.MIN, Align.MIN)
BACK = (Align.CENTER, Align.MAX, Align.MIN)


def build(part):
    d = part.dimensions
    w, l, h = d["width"] - 2 * d["wall"] - 2 * d["play"], d["depth"] - 2 * d["wall"], d["pitch"] - d["wall"] - 2 * d["play"]
    body = Box(w, l, h, align=FRONT) - Pos(0, 6, 6) * Box(w - 12, l - 12, h, align=FRONT)
    body += Pos(0, 0, h / 2) * Box(120, 25, 10, align=BACK) - Pos(0, 0, h / 2 - 1) * Box(100, 15, 20, align=BACK)

    return body, {"drawer_0": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)}}
