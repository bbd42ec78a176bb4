from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
NEAR = (Align.CENTER, Align.MIN, Align.CENTER)


def build(part):
    d = part.dimensions
    body = (
        Box(850, d["thigh"] - 20, d["panel"], align=(Align.CENTER, Align.MAX, Align.CENTER))
        + Rot(Y=90) * Cylinder(d["panel"] / 2, 850)
        + Rot(Y=90) * Cylinder(d["axle"], 920)
    )
    for side in (-1, 1):
        body += (
            Pos(side * 415, 5 - d["thigh"], 0) * Box(20, 40, d["panel"], align=NEAR)
            + Pos(side * 415, -d["thigh"], 0) * Rot(Y=90) * Cylinder(d["panel"] / 2, 20)
            + Pos(side * 405, -d["thigh"], 0) * Rot(Y=-90 * side) * Cylinder(d["axle"], 30, align=LOW)
        )

    return body, {
        "thigh": {"o": (0, 0, 0), "z": (-1, 0, 0), "x": (0, 1, 0)},
        "calf": {"o": (0, -d["thigh"], 0), "z": (1, 0, 0), "x": (0, 1, 0)},
    }
