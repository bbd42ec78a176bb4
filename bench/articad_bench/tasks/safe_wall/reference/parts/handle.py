from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = (
        Pos(0, -0.4, 0) * Rot(X=90) * Cylinder(14, 20, align=LOW)
        + Pos(0, -8, 0) * Box(d["lever_length"], 12, 12, align=(Align.MIN, Align.MAX, Align.CENTER))
        + Rot(X=-90) * Cylinder(d["shaft"], d["door"] - 2, align=LOW)
        + Pos(0, 1, 0) * Rot(X=90) * Cylinder(d["shaft"], 4, align=LOW)
    )
    return body, {"handle": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)}}
