from build123d import Align, Box, Cylinder, Pos

LEFT = (Align.MIN, Align.CENTER, Align.CENTER)


def build(part):
    d = part.dimensions
    body = Pos(-10, 0, 0) * Box(10, 180, d["height"], align=LEFT)
    for side in (-1, 1):
        body += Pos(-1, 0, side * (d["eye"] / 2 + 5.5)) * (Box(31, 32, 10, align=LEFT) + Pos(31, 0, 0) * Cylinder(16, 10))
    body += Pos(30, 0, 0) * Cylinder(d["pin"], d["eye"] + 20)

    return body, {"shoulder": {"o": (30, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
