from build123d import Align, Box, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Cylinder(d["bore"], d["length"], align=LOW) - Cylinder(d["shaft"] + d["clearance"], 300)
    for i in range(8):
        body -= Pos(0, 0, 55 + 4 * i) * (Cylinder(d["bore"] + 2, 2, align=LOW) - Cylinder(d["bore"] - 1, 2, align=LOW))
    body -= Pos(0, d["bore"] - 2, -1) * Box(3, 4, 130, align=(Align.CENTER, Align.MIN, Align.MIN))  # keyway

    return body, {
        "spindle": {"o": (0, 0, -20), "z": (0, 0, -1), "x": (1, 0, 0)},
        "worm": {"o": (0, 0, d["length"]), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
