from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    shape = Rot(Y=90) * Cylinder(d["radius"], d["thickness"]) - Rot(Y=90) * Cylinder(d["bore"], 100) + Pos(0, 0, d["radius"] - 1) * Box(d["thickness"], 3, 4, align=LOW)
    return shape, {
        "axis": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 0, 1)},
    }
