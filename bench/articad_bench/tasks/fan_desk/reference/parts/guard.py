from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
LEFT = (Align.MIN, Align.CENTER, Align.CENTER)


def build(part):
    d = part.dimensions
    body = Rot(X=90) * (Cylinder(d["guard_radius"], 48, align=LOW) - Cylinder(d["guard_radius"] - 4, 100))
    for i in range(4):
        body += Rot(Y=90 * i + 45) * Pos(30, -2, 0) * Box(d["guard_radius"] - 31, 4, 8, align=LEFT)
    body += Rot(X=90) * (Cylinder(38, 4, align=LOW) - Cylinder(26, 20))

    return body, {"guard": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)}}
