from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = (Align.CENTER, Align.MIN, Align.MIN)


def build(part):
    d = part.dimensions
    body = Box(d["width"], d["depth"], d["height"], align=FRONT) - Pos(0, d["wall"], d["wall"]) * Box(
        d["width"] - 2 * d["wall"], d["depth"] - 2 * d["wall"], d["height"], align=FRONT
    )
    for x in (-1, 1):
        for y in (d["wall"], d["depth"] - d["wall"] - 12):
            body += Pos(x * (d["width"] / 2 - 7), y - 0.5, 1) * Box(13, 13, d["height"] - 46, align=FRONT)
        ear = (
            Box(8, 18, 14, align=FRONT)
            + Pos(0, 13, 16) * Rot(Y=90) * Cylinder(5, 8)
            - Pos(0, 13, 16) * Rot(Y=90) * Cylinder(d["pin"] + d["clearance"], 50)
        )
        body += Pos(x * (d["width"] / 2 - 30), d["depth"] - 1, d["height"] - 14) * ear
    body -= Pos(0, -1, d["height"] - 60) * Rot(X=-90) * Cylinder(d["lock"] + d["clearance"], 10, align=LOW)

    return body, {
        "lid": {"o": (0, d["depth"] + 12, d["height"] + 2), "z": (-1, 0, 0), "x": (0, 1, 0)},
        "tray": {"o": (0, d["depth"] / 2, d["height"] - 45), "z": (0, 0, 1), "x": (1, 0, 0)},
        "key": {"o": (0, 0, d["height"] - 60), "z": (0, 1, 0), "x": (1, 0, 0)},
    }
