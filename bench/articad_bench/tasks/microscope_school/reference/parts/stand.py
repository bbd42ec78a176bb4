from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = (Align.CENTER, Align.MIN, Align.MIN)


def build(part):
    d = part.dimensions
    body = (
        Pos(0, 5, 0) * Box(110, 160, 18, align=LOW)
        + Pos(0, d["column_y"], 0) * Box(40, 30, d["height"], align=FRONT)
        + Pos(0, d["column_y"] - 5, 130) * Box(d["tongue"], 8, d["height"] - 130, align=FRONT)
        + Pos(0, d["column_y"] - 5, 130) * Box(d["tongue"] + 8, 2.5, d["height"] - 130, align=FRONT)
    )
    body += Pos(0, -35, d["stage_z"] - 14) * Box(90, d["column_y"] + 40, 14, align=FRONT) + Pos(0, -35, d["stage_z"] - 1) * Box(
        d["tongue"], 60, 5, align=FRONT
    )
    body += Pos(0, -35, d["stage_z"] + 2.4) * Box(d["tongue"] + 8, 60, 1.6, align=FRONT)
    for side in (-1, 1):
        body += Pos(side * 32, -10, 17) * Box(6, 16, 41, align=LOW)
    body += Pos(0, -10, 50) * Rot(Y=90) * Cylinder(d["mirror_pin"], 70)
    body += Pos(18, d["column_y"] + 15, 170) * Rot(Y=90) * Cylinder(d["knob_pin"], 30, align=LOW)

    return body, {
        "stage_y": {"o": (0, 0, d["stage_z"]), "z": (0, 1, 0), "x": (1, 0, 0)},
        "focus": {"o": (0, 0, d["tube_z"]), "z": (0, 0, 1), "x": (1, 0, 0)},
        "knob": {"o": (20, d["column_y"] + 15, 170), "z": (1, 0, 0), "x": (0, 1, 0)},
        "mirror": {"o": (0, -10, 50), "z": (1, 0, 0), "x": (0, 1, 0)},
    }
