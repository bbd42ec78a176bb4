from build123d import Align, Box, Pos

HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    length, height, thickness, drop = d["length"], d["height"], d["thickness"], d["drop"]
    shape = Pos(length / 2, -thickness / 2, -drop) * Box(length, thickness, height, align=HIGH)
    return shape, {"side": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
