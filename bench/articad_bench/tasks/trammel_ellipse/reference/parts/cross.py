from build123d import Align, Box, Pos

HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    shape = Pos(0, 0, -d["play"]) * Box(2 * d["half"], 2 * d["half"], d["board"], align=HIGH)
    for a, b in ((2 * d["half"], d["groove"]), (d["groove"], 2 * d["half"])):
        shape -= Pos(0, 0, -d["play"]) * Box(a, b, 2 * d["deep"])
    return shape, {
        "shuttle_x": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 0, 1)},
        "shuttle_y": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)},
    }
