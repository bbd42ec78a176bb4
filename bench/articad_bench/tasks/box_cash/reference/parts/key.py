from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(0, -4, 0) * Rot(X=-90) * Cylinder(d["lock"], 12, align=LOW) + Pos(0, -3, 0) * Box(
        3, 20, d["bow"], align=(Align.CENTER, Align.MAX, Align.CENTER)
    )
    return body, {"key": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)}}
