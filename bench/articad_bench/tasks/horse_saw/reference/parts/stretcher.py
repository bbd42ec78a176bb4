from build123d import Align, Box

HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    length, width, thickness, seat_y = d["length"], d["width"], d["thickness"], d["seat_y"]
    shape = Box(width, length, thickness, align=HIGH)
    return shape, {"leg": {"o": (0, seat_y, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
