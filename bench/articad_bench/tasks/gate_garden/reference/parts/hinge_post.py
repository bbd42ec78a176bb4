from build123d import Align, Box, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
LEFT_LOW = (Align.MIN, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(-60, 0, 0) * Box(80, 80, d["post_height"], align=LOW)
    for z in (150, 750):
        body += (
            Pos(-25, 0, z) * Box(25, 24, 16, align=LEFT_LOW)
            + Pos(0, 0, z) * Cylinder(12, 16, align=LOW)
            + Pos(0, 0, z) * Cylinder(d["pin_radius"], 56, align=LOW)
        )

    return body, {
        "left_foot": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "hinge": {"o": (0, 0, 167), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
