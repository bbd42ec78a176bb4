from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Box(d["length"], 40, 10, align=LOW) + Pos(d["length"] / 2 - 18, 0, 9) * Box(20, 12, 2, align=LOW)
    for side in (-1, 1):
        body += Pos(d["pin_x"], side * 14.5, 9) * Box(16, 5, d["pin_z"] - 2, align=LOW)
    body += Pos(d["pin_x"], 0, d["pin_z"]) * Rot(X=90) * Cylinder(d["pin"], 34)

    return body, {"magazine": {"o": (d["pin_x"], 0, d["pin_z"]), "z": (0, -1, 0), "x": (1, 0, 0)}}
