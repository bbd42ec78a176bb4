from math import cos, radians, sin

from build123d import Align, Box, Cylinder, Pos, Rot

LEFT = (Align.MIN, Align.CENTER, Align.CENTER)


def build(part):
    d = part.dimensions
    body = Rot(X=90) * Cylinder(d["axle"], 130)
    for i in range(6):
        arm = (
            Pos(0, (d["width"] + 5) / 2, 0) * Box(d["rim"] + 8, 5, 14, align=LEFT)
            + Pos(0, -(d["width"] + 5) / 2, 0) * Box(d["rim"] + 8, 5, 14, align=LEFT)
            + Pos(d["rim"], 0, 0) * Rot(X=90) * Cylinder(d["pin"], d["width"] + 8)
        )
        body += Rot(Y=60 * i) * arm
    for side in (-1, 1):
        body += Pos(0, side * (d["width"] + 5) / 2, 0) * Rot(X=90) * Cylinder(20, 5)

    return body, {
        "axle": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)},
        "pin_0": {"o": (d["rim"] * cos(radians(0)), 0, -d["rim"] * sin(radians(0))), "z": (0, 1, 0), "x": (1, 0, 0)},
        "pin_1": {"o": (d["rim"] * cos(radians(60)), 0, -d["rim"] * sin(radians(60))), "z": (0, 1, 0), "x": (1, 0, 0)},
        "pin_2": {"o": (d["rim"] * cos(radians(120)), 0, -d["rim"] * sin(radians(120))), "z": (0, 1, 0), "x": (1, 0, 0)},
        "pin_3": {"o": (d["rim"] * cos(radians(180)), 0, -d["rim"] * sin(radians(180))), "z": (0, 1, 0), "x": (1, 0, 0)},
        "pin_4": {"o": (d["rim"] * cos(radians(240)), 0, -d["rim"] * sin(radians(240))), "z": (0, 1, 0), "x": (1, 0, 0)},
        "pin_5": {"o": (d["rim"] * cos(radians(300)), 0, -d["rim"] * sin(radians(300))), "z": (0, 1, 0), "x": (1, 0, 0)},
        "crank": {"o": (0, -57, 0), "z": (0, 1, 0), "x": (1, 0, 0)},
    }
