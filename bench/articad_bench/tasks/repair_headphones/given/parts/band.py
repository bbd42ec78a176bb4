from build123d import Align, Box, Cylinder, Pos, Rot

HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    body = Rot(X=90) * (Cylinder(d["band_radius"], d["band_width"]) - Cylinder(d["band_radius"] - 6, 2 * d["band_width"])) - Box(
        4 * d["band_radius"], 100, 2 * d["band_radius"], align=HIGH
    )
    for side in (-1, 1):
        socket = Pos(0, 0, 1) * Box(14, d["band_width"], 41, align=HIGH) - Pos(0, 0, -2) * Box(
            d["arm_thick"] + 2 * d["play"], d["arm_width"] + 2 * d["play"], 60, align=HIGH
        )
        body += Pos(side * (d["band_radius"] - 3), 0, 0) * socket

    return body, {
        "size": {"o": (d["band_radius"] - 3, 0, -3), "z": (0, 0, -1), "x": (1, 0, 0)},
        "left_size": {"o": (3 - d["band_radius"], 0, -3), "z": (0, 0, -1), "x": (-1, 0, 0)},
    }
