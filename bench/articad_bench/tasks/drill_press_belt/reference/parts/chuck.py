from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    shape = Pos(0, 0, -d["low"] - 1) * Cylinder(d["shaft_r"], d["low"] + d["top"] + 1, align=LOW) + Pos(0, 0, -d["low"] - d["chuck_h"]) * Cylinder(d["chuck_r"], d["chuck_h"], align=LOW) + Pos(0, 0, -d["low"] - d["chuck_h"] - d["drill_l"]) * Cylinder(d["drill_r"], d["drill_l"] + 1, align=LOW)
    return shape, {
        "axis": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
