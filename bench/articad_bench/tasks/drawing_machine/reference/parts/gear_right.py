from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    shape = Cylinder(d["radius"], d["thickness"], align=LOW) - Pos(-d["radius"] / 2, 0, 0) * Cylinder(d["hole"], 100)
    shape -= Pos(0, 0, 0) * Cylinder(d["bore_r"], 1000)
    shape += Pos(d["throw"], 0, d["thickness"] / 2) * Cylinder(d["pin_r"], d["b_high"] - (d["thickness"] / 2), align=LOW)
    return shape, {
        "q": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "b": {"o": (d["throw"], 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
