from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    shape = Pos(0, 0, -d["top"] - d["length"]) * Cylinder(d["radius"], d["length"], align=LOW) - Cylinder(d["bore"], 1000)
    return shape, {
        "axis": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "chuck": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
