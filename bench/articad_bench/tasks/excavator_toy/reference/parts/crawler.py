from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
LEFT = (Align.MIN, Align.CENTER, Align.CENTER)


def build(part):
    d = part.dimensions
    body = Pos(0, 0, 14) * Box(d["length"] - 20, 60, d["deck_z"] - 14, align=LOW)
    for side in (-1, 1):
        body += Pos(0, 36 * side, 0) * Box(d["length"], 22, d["deck_z"], align=LOW)
        body += Pos(d["blade_x"] - 6, 18 * side, d["blade_z"]) * Box(36, 6, 14, align=LEFT)
    body += Pos(d["blade_x"], 0, d["blade_z"]) * Rot(X=90) * Cylinder(d["root_pin"], 42)
    body -= Pos(0, 0, d["deck_z"]) * Cylinder(10.3, 30)

    return body, {
        "slew": {"o": (0, 0, d["deck_z"]), "z": (0, 0, 1), "x": (1, 0, 0)},
        "blade": {"o": (d["blade_x"], 0, d["blade_z"]), "z": (0, 1, 0), "x": (1, 0, 0)},
    }
