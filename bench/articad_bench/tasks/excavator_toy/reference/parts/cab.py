from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)
LEFT = (Align.MIN, Align.CENTER, Align.CENTER)


def build(part):
    d = part.dimensions
    body = Pos(0, 0, 0.4) * Box(80, 60, d["height"], align=LOW) + Pos(0, 0, 1) * Cylinder(10, 15, align=HIGH)
    for side in (-1, 1):
        body += Pos(30, 10.5 * side, d["hinge_z"]) * Box(d["hinge_x"] - 22, 6, 16, align=LEFT)
    body += Pos(d["hinge_x"], 0, d["hinge_z"]) * Rot(X=90) * Cylinder(d["root_pin"], 27)

    return body, {
        "slew": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "boom": {"o": (d["hinge_x"], 0, d["hinge_z"]), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
