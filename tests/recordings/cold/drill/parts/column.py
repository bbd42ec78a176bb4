from build123d import Align, Cylinder, Pos

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length = d["length"]
    shape = Cylinder(d["radius"], length, align=UP) - Pos(0, 0, -1) * Cylinder(d["inner_radius"], length + 2, align=UP)
    return shape, {
        "foot": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "top": {"o": (0, 0, length), "z": (0, 0, 1), "x": (1, 0, 0)},
        "table": {"o": (0, 0, d["table_z"]), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
