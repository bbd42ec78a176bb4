from build123d import Align, Box, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    body = Box(d["leg"], d["leg"], 120, align=HIGH) + Pos(0, 0, -d["leg_height"]) * Box(d["foot"], d["foot"], d["leg_height"], align=LOW)

    return body, {"leg_0": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
