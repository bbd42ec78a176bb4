from build123d import Align, Box, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    shape = Pos(0, 0, d["gap"]) * Cylinder(d["disc_r"], d["thickness"], align=LOW) + Pos(0, 0, d["gap"]) * Cylinder(d["shaft_r"], d["reach"] - d["gap"], align=LOW)
    shape += Pos(0, 0, d["gap"] - d["deep"]) * Box(2 * d["disc_r"] - 4, d["tongue"], d["deep"] + d["thickness"] / 2, align=LOW)
    return shape, {
        "shaft": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "tongue": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 0, 1)},
    }
