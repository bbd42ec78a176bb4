from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Box(d["floor"], 130, 10, align=LOW)
    for side in (-1, 1):
        body += Pos(0, side * 50, 9) * Box(40, 10, d["axle_z"] + 11, align=LOW)
    body -= Pos(0, 0, d["axle_z"]) * Rot(X=90) * Cylinder(d["axle"] + d["clearance"], 300)

    return body, {"axle": {"o": (0, 0, d["axle_z"]), "z": (0, 1, 0), "x": (1, 0, 0)}}
