from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = (
        Cylinder(6, 2, align=LOW) + Pos(-24, -10, 0) * Cylinder(11, 2, align=LOW) + Pos(-12, -5, 0) * Rot(Z=22.6) * Box(26, 8, 2, align=LOW)
    )
    body -= Cylinder(d["pin_radius"] + d["clearance"], 10)

    return body, {"cover": {"o": (0, 0, -0.2), "z": (0, 0, -1), "x": (1, 0, 0)}}
