from build123d import Align, Box, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    body = Box(d["grip_width"], 26, 24, align=LOW)
    for x in (-80, 80):
        body += Pos(x, 0, 1) * Cylinder(d["rod"], 241, align=HIGH)

    return body, {"second": {"o": (0, 0, -0.5), "z": (0, 0, 1), "x": (1, 0, 0)}}
