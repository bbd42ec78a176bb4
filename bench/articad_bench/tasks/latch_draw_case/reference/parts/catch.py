from build123d import Align, Box, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length, width, thickness, hook, hook_height = d["length"], d["width"], d["thickness"], d["hook"], d["hook_height"]
    lip = d["lip"]
    shape = Box(length, width, thickness, align=LOW) + Pos(0, 0, 0) * Box(hook, 0.6 * width, hook_height, align=LOW)
    shape += Pos(hook / 2, 0, hook_height - 3) * Box(lip, 0.6 * width, 3, align=(Align.MIN, Align.CENTER, Align.MIN))
    return shape, {"board": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
