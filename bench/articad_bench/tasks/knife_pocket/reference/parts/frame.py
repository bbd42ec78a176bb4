from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Box(d["length"], d["width"], d["height"], align=LOW)
    for i in (-1, 0, 1):
        body -= Pos(0, i * d["lane"], 5) * Box(2 * d["length"], d["slot"], d["height"], align=LOW)
    for x in (-d["pin_x"], d["pin_x"]):
        body += Pos(x, 0, d["pin_z"]) * Rot(X=90) * Cylinder(d["pin"], d["width"])

    return body, {
        "blade": {"o": (-d["pin_x"], -d["lane"], d["pin_z"]), "z": (0, -1, 0), "x": (1, 0, 0)},
        "file": {"o": (d["pin_x"], 0, d["pin_z"]), "z": (0, 1, 0), "x": (1, 0, 0)},
        "opener": {"o": (-d["pin_x"], d["lane"], d["pin_z"]), "z": (0, -1, 0), "x": (1, 0, 0)},
        "screwdriver": {"o": (d["pin_x"], d["lane"], d["pin_z"]), "z": (0, 1, 0), "x": (1, 0, 0)},
        "glue": {"o": (0, -d["width"] / 2, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "back_glue": {"o": (0, d["width"] / 2, 0), "z": (0, 1, 0), "x": (1, 0, 0)},
    }
