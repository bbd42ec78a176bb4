from build123d import Align, Box, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Box(d["length"], d["width"], d["board"] + d["rim"], align=LOW) - Pos(0, 0, d["board"]) * Box(
        d["length"] - 20, d["width"] - 20, 100, align=LOW
    )
    body -= Pos(0, 0, d["board"]) * Box(2 * d["length"], 120, 100, align=LOW)

    return body, {
        "puck": {"o": (0, 0, d["board"]), "z": (0, 0, 1), "x": (1, 0, 0)},
        "pusher": {"o": (-230, 0, d["board"]), "z": (0, 0, 1), "x": (1, 0, 0)},
        "second_pusher": {"o": (230, 0, d["board"]), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
