from build123d import Align, Box, Pos

CORNER = (Align.MIN, Align.MIN, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(d["gate_right"] + 20, -15, 0) * Box(80, 80, d["post_height"], align=CORNER)
    body += Pos(d["gate_right"] + 24, -15, d["latch_z"] - 22) * Box(16, 22, 11, align=(Align.MIN, Align.MAX, Align.MIN)) + Pos(
        d["gate_right"] + 24, -29, d["latch_z"] - 22
    ) * Box(16, 8, 26, align=(Align.MIN, Align.MAX, Align.MIN))

    return body, {"right_foot": {"o": (d["gate_right"] + 40, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
