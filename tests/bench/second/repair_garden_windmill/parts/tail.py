from build123d import Align, Box, Pos


def build(part):
    d = part.dimensions
    body = Box(100, 4, 46, align=(Align.MAX, Align.CENTER, Align.CENTER)) + Pos(-90, 0, 0) * Box(
        d["fin_length"] - 90, 4, 120, align=(Align.MAX, Align.CENTER, Align.CENTER)
    )
    return body, {"fin": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}}
