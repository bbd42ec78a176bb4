from build123d import Align, Box, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(0, 0, 0.4) * Box(d["lever_length"], d["slot_width"] - 0.8, 50, align=LOW) + Pos(0, 0, 45) * Box(24, 50, 20, align=LOW)
    return body, {"throttle": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}}
