from math import cos, radians, sin

from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
LEFT = (Align.MIN, Align.CENTER, Align.CENTER)


def build(part):
    d = part.dimensions
    body = Cylinder(d["radius"], d["height"], align=LOW)
    for i in range(3):
        fork = Box(d["hinge_reach"] + 8 - d["radius"] / 2, d["eye_width"] + 1 + 2 * d["ear"], 16, align=LEFT) - Box(
            200, d["eye_width"] + 1, 20
        )
        body += Rot(Z=120 * i) * Pos(d["radius"] / 2, 0, d["hinge_z"]) * fork
        body += (
            Rot(Z=120 * i)
            * Pos(d["hinge_reach"], 0, d["hinge_z"])
            * Rot(X=90)
            * Cylinder(d["pin_radius"], d["eye_width"] + 1 + 2 * d["ear"])
        )
    body -= Pos(0, 0, d["height"] / 2) * Cylinder(d["column_radius"] + d["clearance"], d["height"] + 20)

    return body, {
        "hinge": {"o": (d["hinge_reach"], 0, d["hinge_z"]), "z": (0, -1, 0), "x": (0, 0, 1)},
        "hinge_b": {
            "o": (d["hinge_reach"] * cos(radians(120)), d["hinge_reach"] * sin(radians(120)), d["hinge_z"]),
            "z": (sin(radians(120)), -cos(radians(120)), 0),
            "x": (0, 0, 1),
        },
        "hinge_c": {
            "o": (d["hinge_reach"] * cos(radians(240)), d["hinge_reach"] * sin(radians(240)), d["hinge_z"]),
            "z": (sin(radians(240)), -cos(radians(240)), 0),
            "x": (0, 0, 1),
        },
        "column": {"o": (0, 0, 30), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
