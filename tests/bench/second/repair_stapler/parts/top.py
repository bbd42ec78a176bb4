from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
LEFT_LOW = (Align.MIN, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(-8, 0, 7) * Box(d["reach"] + 8, d["eye"] + 7, 10, align=LEFT_LOW)
    for side in (-1, 1):
        body += Pos(0, side * (d["eye"] / 2 + 2), 0) * (Rot(X=90) * Cylinder(8, 3) + Box(16, 3, 12, align=LOW))
    body -= Rot(X=90) * Cylinder(d["pin"] + d["clearance"], 60)

    return body, {"top": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)}}
