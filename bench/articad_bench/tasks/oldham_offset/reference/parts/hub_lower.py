from build123d import Align, Box, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    shape = Pos(0, 0, -d["gap"] - d["thickness"]) * Cylinder(d["disc_r"], d["thickness"], align=LOW) + Pos(0, 0, -d["reach"]) * Cylinder(d["shaft_r"], d["reach"] - d["gap"], align=LOW)
    shape += Pos(0, 0, -d["gap"] - d["thickness"] / 2) * Box(d["tongue"], 2 * d["disc_r"] - 4, d["deep"] + d["thickness"] / 2, align=LOW)
    return shape, {
        "shaft": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "tongue": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)},
    }
