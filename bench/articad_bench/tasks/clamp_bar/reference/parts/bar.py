from build123d import Align, Box, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
LEFT_LOW = (Align.MIN, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(0, 0, -10) * (
        Box(d["bar_width"], d["bar_thick"], d["bar_length"] + 10, align=LOW)
        + Box(d["reach"] + 16, 18, 26, align=LEFT_LOW)
        + Box(d["bar_width"], 18, 26, align=LOW)
    )
    return body, {"slide": {"o": (0, 0, 180), "z": (0, 0, 1), "x": (1, 0, 0)}}
