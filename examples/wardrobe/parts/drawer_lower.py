from build123d import Align, Box, Pos

FRONT = (Align.CENTER, Align.MIN, Align.MIN)


def build(part):
    d = part.dimensions
    width, length, side, thick = d["width"], d["length"], d["side"], d["thickness"]
    tray = Box(width, length, d["side_height"], align=FRONT) + Box(width, thick, d["height"], align=FRONT)
    tray -= Pos(0, thick, d["floor"]) * Box(width - 2 * side, length - thick - side, d["height"], align=FRONT)

    groove = Box(2 * d["groove_depth"], length, d["groove_height"], align=(Align.CENTER, Align.MIN, Align.CENTER))
    for x in (-width / 2, width / 2):
        tray -= Pos(x, thick, d["groove_z"]) * groove
    return tray, {
        "slide": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "handle": {"o": (0, 0, d["handle_z"]), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
