from build123d import Align, Box, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    shape = Pos(20, (d["front"] + d["back"]) / 2, -d["low"]) * Box(d["width"], d["back"] - d["front"], d["board"], align=HIGH) + Pos(20, (d["front"] + d["back"]) / 2, d["height"] - d["low"]) * Box(d["width"], d["back"] - d["front"], d["board"], align=LOW)
    shape += Pos(20, d["back"] - d["board"] / 2, -d["low"] - d["board"] / 2) * Box(d["width"], d["board"], d["height"] + d["board"], align=LOW)
    shape -= Pos(0, 0, -d["low"]) * Cylinder(d["bore"], 4 * d["board"], align=(Align.CENTER, Align.CENTER, Align.CENTER)) + Pos(d["offset"], 0, d["height"] - d["low"]) * Cylinder(d["bore"], 4 * d["board"])
    return shape, {
        "input": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "output": {"o": (d["offset"], 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
