from build123d import Align, Box, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    side, thickness, to_back = d["side"], d["thickness"], d["to_back"]
    shape = Pos(0, to_back - side / 2, 0) * Box(side, side, thickness, align=LOW)
    return shape, {"front": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
