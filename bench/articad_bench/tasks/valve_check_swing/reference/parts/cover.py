from build123d import Align, Box

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length, width, thickness = d["length"], d["width"], d["thickness"]
    shape = Box(length, width, thickness, align=LOW)
    return shape, {"body": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
