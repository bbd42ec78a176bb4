from build123d import Align, Box, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    shape = Pos(0, 0, -d["height"] / 2 - d["board"]) * Box(d["width"], d["depth"], d["board"], align=LOW) + Pos(0, 0, d["height"] / 2) * Box(d["width"], d["depth"], d["board"], align=LOW)
    shape += Pos(0, d["depth"] / 2 - d["board"] / 2, 0) * Box(d["width"], d["board"], d["height"] + d["board"])
    shape -= Pos(0, 0, d["height"] / 2) * Cylinder(d["bore"], 3 * d["board"]) + Pos(d["offset"], 0, -d["height"] / 2) * Cylinder(d["bore"], 3 * d["board"])
    return shape, {
        "upper": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "lower": {"o": (d["offset"], 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
