from build123d import Align, Box, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    w, l = d["width"] - 2 * d["wall"] - 2, d["depth"] - 2 * d["wall"] - 2
    body = Box(w, l, 40, align=LOW)
    for i in range(3):
        for j in (-1, 1):
            body -= Pos((i - 1) * w / 3, j * l / 4, 3) * Box(w / 3 - 5, l / 2 - 5, 40, align=LOW)

    return body, {"tray": {"o": (0, 0, -0.2), "z": (0, 0, 1), "x": (1, 0, 0)}}
