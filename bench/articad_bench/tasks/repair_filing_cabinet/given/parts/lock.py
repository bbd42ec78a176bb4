from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(0, -3, 0) * Rot(X=-90) * Cylinder(d["lock_radius"], 23, align=LOW) + Pos(0, -0.5, 0) * Box(
        4, 25, 30, align=(Align.CENTER, Align.MAX, Align.CENTER)
    )
    body += Pos(0, 10, 0) * Rot(X=-90) * Cylinder(d["lock_radius"] + 2, 3, align=LOW)
    return body, {"lock": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)}}
