from build123d import Align, Box, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    body = Box(2 * 80 + d["bar"], d["bar"] - 4, 10, align=LOW)
    for x in (-80, 80):
        body += Pos(x, 0, 1) * Cylinder(d["tube"], 301, align=HIGH)
    for x in (-80, 80):
        body -= Pos(x, 0, -250) * Cylinder(d["rod"] + d["clearance"], 400, align=LOW)

    return body, {"first": {"o": (0, 0, -0.5), "z": (0, 0, 1), "x": (1, 0, 0)}, "second": {"o": (0, 0, 10), "z": (0, 0, 1), "x": (1, 0, 0)}}
