from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = (Align.CENTER, Align.MIN, Align.MIN)


def build(part):
    d = part.dimensions
    body = Box(d["width"], d["depth"], d["height"], align=FRONT)
    for i in range(3):
        body -= Pos(0, -1, d["wall"] + i * d["pitch"]) * Box(
            d["width"] - 2 * d["wall"], d["depth"] - d["wall"] + 1, d["pitch"] - d["wall"], align=FRONT
        )
    for x in (-1, 1):
        for y in (40, d["depth"] - 40):
            body -= Pos(x * (d["width"] / 2 - 40), y, -1) * Cylinder(d["foot_radius"] + d["clearance"], d["wall"] + 2, align=LOW)
    body -= Pos(d["width"] / 2 - 60, -1, d["height"] - 28) * Rot(X=-90) * Cylinder(d["lock_radius"] + d["clearance"], 25, align=LOW)
    body -= Pos(d["width"] / 2 - 60, 9.7, d["height"] - 28) * Rot(X=-90) * Cylinder(d["lock_radius"] + d["clearance"] + 2, 3.6, align=LOW)

    return body, {
        "drawer_0": {"o": (0, 0, d["wall"] + d["play"] + 0 * d["pitch"]), "z": (0, -1, 0), "x": (1, 0, 0)},
        "drawer_1": {"o": (0, 0, d["wall"] + d["play"] + 1 * d["pitch"]), "z": (0, -1, 0), "x": (1, 0, 0)},
        "drawer_2": {"o": (0, 0, d["wall"] + d["play"] + 2 * d["pitch"]), "z": (0, -1, 0), "x": (1, 0, 0)},
        "lock": {"o": (d["width"] / 2 - 60, 0, d["height"] - 28), "z": (0, -1, 0), "x": (1, 0, 0)},
        "level_0": {"o": (40 - d["width"] / 2, 40, 0), "z": (0, 0, -1), "x": (1, 0, 0)},
        "level_1": {"o": (d["width"] / 2 - 40, 40, 0), "z": (0, 0, -1), "x": (1, 0, 0)},
        "level_2": {"o": (40 - d["width"] / 2, d["depth"] - 40, 0), "z": (0, 0, -1), "x": (1, 0, 0)},
        "level_3": {"o": (d["width"] / 2 - 40, d["depth"] - 40, 0), "z": (0, 0, -1), "x": (1, 0, 0)},
    }
