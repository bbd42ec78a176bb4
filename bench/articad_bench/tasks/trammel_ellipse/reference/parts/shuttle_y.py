from build123d import Align, Box, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    shape = Pos(0, 0, -d["play"]) * Box(d["wide"], d["long"], d["deep"], align=HIGH) + Pos(0, 0, -d["play"] - d["deep"] / 2) * Cylinder(d["pin_r"], d["top"] + d["play"] + d["deep"] / 2, align=LOW)
    return shape, {
        "slide": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)},
        "y": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
