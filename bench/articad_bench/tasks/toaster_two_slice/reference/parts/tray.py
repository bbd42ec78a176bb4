from build123d import Align, Box, Pos


def build(part):
    d = part.dimensions
    body = Box(d["length"] - 30, d["depth"] - 42, d["tray_height"], align=(Align.MAX, Align.CENTER, Align.MIN)) - Pos(-1.5, 0, 1.5) * Box(
        d["length"] - 33, d["depth"] - 45, d["tray_height"], align=(Align.MAX, Align.CENTER, Align.MIN)
    )
    body += Pos(31 - d["length"], 0, 0) * Box(24, 50, 6, align=(Align.MAX, Align.CENTER, Align.MIN))

    return body, {"tray": {"o": (0, 0, -0.3), "z": (-1, 0, 0), "x": (0, 1, 0)}}
