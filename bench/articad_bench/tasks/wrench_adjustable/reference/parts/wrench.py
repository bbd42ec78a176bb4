from build123d import Align, Box, Cylinder, Pos, Rot

LEFT = (Align.MIN, Align.CENTER, Align.CENTER)
LEFT_LOW = (Align.MIN, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = (
        Pos(-180, 0, 0) * Box(160, d["thick"], 22, align=LEFT)
        + Pos(-24, 0, 0) * Box(54, d["thick"], 44, align=LEFT)
        + Pos(29, 0, 8) * Box(31, d["thick"], 14, align=LEFT_LOW)
    )
    body -= (
        Pos(d["hole_x"], 0, 0) * Rot(X=90) * Cylinder(6, 50)
        + Pos(d["rod_x"], 0, 0) * Cylinder(d["rod"] + d["clearance"], 100)
        + Pos(-4, 0, 0) * Box(18, 50, 16)
    )
    body += Pos(-4, 0, 0) * Cylinder(d["worm_pin"], 30)

    return body, {
        "jaw": {"o": (0, 0, 0), "z": (0, 0, -1), "x": (1, 0, 0)},
        "worm": {"o": (-4, 0, 0), "z": (0, 0, -1), "x": (1, 0, 0)},
        "ring": {"o": (d["hole_x"], 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)},
    }
