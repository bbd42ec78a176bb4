from build123d import Align, Box, Cylinder, Pos, Rot

LEFT_LOW = (Align.MIN, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = (
        Rot(X=90) * Cylinder(6.5, d["eye"])
        + Pos(0, 0, -6) * Box(20, d["eye"] - 2, 6, align=LEFT_LOW)
        + Pos(12, 0, -8) * Box(d["reach"] - 12, 16, 12, align=LEFT_LOW)
    )
    body -= Pos(16, 0, -5) * Box(d["reach"] - 19, d["channel"], 20, align=LEFT_LOW) + Rot(X=90) * Cylinder(d["pin"] + d["clearance"], 50)

    return body, {
        "magazine": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "top": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "pusher": {"o": (120, 0, -5), "z": (-1, 0, 0), "x": (0, 1, 0)},
    }
