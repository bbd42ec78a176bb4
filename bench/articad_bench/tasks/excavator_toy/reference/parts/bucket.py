from build123d import Align, Box, Cylinder, Pos, Rot

LEFT = (Align.MIN, Align.CENTER, Align.CENTER)


def build(part):
    d = part.dimensions
    body = Pos(12, 0, 0) * (Box(40, d["width"], 30, align=LEFT) - Pos(4, 0, -4) * Box(32, d["width"] - 8, 30, align=LEFT))
    for side in (-1, 1):
        body += Pos(0, 7.3 * side, 0) * (Rot(X=90) * Cylinder(8, 6) + Box(14, 6, 16, align=LEFT))
    body += Rot(X=90) * Cylinder(d["pin"], 16)

    return body, {"bucket": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)}}
