from math import cos, radians, sin

from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
LEFT_LOW = (Align.MIN, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(0, 0, 40) * Cylinder(32, d["tube_top"] - 40, align=LOW)
    for i in range(3):
        body += Rot(Z=120 * i + 60) * (
            Pos(0, 0, d["pad"] + 40) * Box(d["reach"] + 15, d["leg_width"], 40, align=LEFT_LOW)
            + Pos(d["reach"], 0, d["pad"]) * Cylinder(14, 60, align=LOW)
        )
    body -= Pos(0, 0, d["tube_top"] - 280) * Cylinder(d["spindle"] + d["clearance"], 400, align=LOW)
    body -= Pos(0, 0, d["tube_top"] - 40) * Rot(Y=90) * Cylinder(d["clamp"] + d["clearance"], 60, align=LOW)

    return body, {
        "spindle": {"o": (0, 0, d["tube_top"]), "z": (0, 0, 1), "x": (1, 0, 0)},
        "clamp": {"o": (32, 0, d["tube_top"] - 40), "z": (1, 0, 0), "x": (0, 1, 0)},
        "glue_0": {
            "o": (d["reach"] * cos(radians(60)), d["reach"] * sin(radians(60)), d["pad"]),
            "z": (0, 0, 1),
            "x": (cos(radians(0)), sin(radians(0)), 0),
        },
        "glue_1": {
            "o": (d["reach"] * cos(radians(180)), d["reach"] * sin(radians(180)), d["pad"]),
            "z": (0, 0, 1),
            "x": (cos(radians(120)), sin(radians(120)), 0),
        },
        "glue_2": {
            "o": (d["reach"] * cos(radians(300)), d["reach"] * sin(radians(300)), d["pad"]),
            "z": (0, 0, 1),
            "x": (cos(radians(240)), sin(radians(240)), 0),
        },
    }
