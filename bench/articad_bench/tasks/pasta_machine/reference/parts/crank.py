from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = (
        Rot(Y=90) * (Cylinder(12, 24, align=LOW) - Cylinder(d["axle"], 12, align=LOW))
        + Pos(16, 0, -8) * Box(7, 14, d["throw"] - 8, align=(Align.MIN, Align.CENTER, Align.MAX))
        + Pos(17, 0, -d["throw"]) * Rot(Y=90) * Cylinder(9, 66, align=LOW)
    )
    return body, {"crank": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}}
