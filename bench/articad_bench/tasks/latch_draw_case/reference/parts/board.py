from build123d import Align, Box

HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    length, width, thickness, catch_x, base_x = d["length"], d["width"], d["thickness"], d["catch_x"], d["base_x"]
    shape = Box(length, width, thickness, align=HIGH)
    return shape, {
        "base": {"o": (base_x, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "catch": {"o": (catch_x, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
