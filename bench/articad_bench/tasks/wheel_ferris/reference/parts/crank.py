from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = (
        Rot(X=90) * Cylinder(12, 10, align=LOW)
        + Pos(0, -4, 0) * Box(d["throw"], 6, 12, align=(Align.MIN, Align.MAX, Align.CENTER))
        + Pos(d["throw"], -4, 0) * Rot(X=90) * Cylinder(6, 36, align=LOW)
        - Rot(X=90) * Cylinder(d["axle"], 8, align=LOW)
    )
    return body, {"crank": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)}}
