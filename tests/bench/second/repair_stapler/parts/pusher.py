from build123d import Align, Box, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(0, 0, 0.3) * Box(d["block"], d["channel"] - 0.6, 8, align=LOW)
    return body, {"pusher": {"o": (0, 0, 0), "z": (-1, 0, 0), "x": (0, 1, 0)}}
