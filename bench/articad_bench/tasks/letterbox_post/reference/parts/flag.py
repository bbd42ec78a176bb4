from build123d import Align, Box, Cylinder, Pos, Rot


def build(part):
    d = part.dimensions
    body = Pos(0, -8, 0) * Box(3, d["reach"], 12, align=(Align.MIN, Align.MIN, Align.CENTER)) + Pos(0, d["reach"] - 48, -6) * Box(
        3, 40, 36, align=(Align.MIN, Align.MIN, Align.MIN)
    )
    body -= Rot(Y=90) * Cylinder(d["bore"], 20)

    return body, {"flag": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}}
