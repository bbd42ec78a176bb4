from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = (Align.CENTER, Align.MIN, Align.MIN)


def build(part):
    d = part.dimensions
    body = Box(d["width"], d["depth"], d["height"], align=FRONT) - Pos(0, d["wall"], d["wall"]) * Box(
        d["width"] - 2 * d["wall"], d["depth"] - 2 * d["wall"], d["height"], align=FRONT
    )
    body -= Pos(0, -1, d["door_z"] - 4) * Box(d["width"] - 2 * d["wall"], d["wall"] + 1, d["door_height"] + 8, align=FRONT)
    body -= Pos(0, 2, d["door_z"]) * Rot(Y=90) * Cylinder(d["pin_radius"] + d["clearance"], d["width"] + 2)
    for side in (-1, 1):
        ear = Box(8, 10, 16, align=FRONT) - Pos(0, 5, 10.5) * Rot(Y=90) * Cylinder(d["pin_radius"] + d["clearance"], 10)
        body += Pos(side * (d["width"] / 2 - 10), d["depth"], d["height"] - 8) * ear
    body += Pos(d["width"] / 2 - 1, 20, d["height"] / 2) * Rot(Y=90) * Cylinder(3, 8, align=LOW)

    return body, {
        "stand": {"o": (0, d["depth"] / 2, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "lid": {"o": (0, d["depth"] + 5, d["height"] + 2.5), "z": (-1, 0, 0), "x": (0, 1, 0)},
        "door": {"o": (0, 2, d["door_z"]), "z": (1, 0, 0), "x": (0, 1, 0)},
        "flag": {"o": (d["width"] / 2 + 0.5, 20, d["height"] / 2), "z": (1, 0, 0), "x": (0, 1, 0)},
    }
