from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    shape = Pos(0, 0, 0) * Cylinder(d["radius"], d["thickness"], align=LOW)
    shape -= Pos(d["radius"] - 2 * d["mark"], 0, 0) * Cylinder(d["mark"], 1000)
    shape -= Pos(0, 0, 0) * Cylinder(d["bore_r"], 1000)
    return shape, {
        "p1": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
