from build123d import Align, Box, Cylinder, Pos, Rot

NEAR = (Align.CENTER, Align.MIN, Align.CENTER)


def build(part):
    d = part.dimensions
    body = (
        Pos(0, 0, 0) * Box(850, d["back"], d["panel"], align=NEAR)
        + Rot(Y=90) * Cylinder(d["panel"] / 2, 850)
        + Rot(Y=90) * Cylinder(d["axle"], 920)
    )
    return body, {"back": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}}
