from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    shape = Pos(0, 0, 0) * Cylinder(d["disc_r"], d["thickness"], align=LOW)
    shape += Pos(0, 0, -d["shaft"]) * Cylinder(d["shaft_r"], d["shaft"] + 1, align=LOW)
    shape += Pos(d["ring"] * 0.0, d["ring"] * 1.0, d["thickness"] / 2) * Cylinder(d["pin_r"], d["a1_high"] - (d["thickness"] / 2), align=LOW)
    shape += Pos(d["ring"] * -0.866025403784, d["ring"] * -0.5, d["thickness"] / 2) * Cylinder(d["pin_r"], d["a2_high"] - (d["thickness"] / 2), align=LOW)
    shape += Pos(d["ring"] * 0.866025403784, d["ring"] * -0.5, d["thickness"] / 2) * Cylinder(d["pin_r"], d["a3_high"] - (d["thickness"] / 2), align=LOW)
    return shape, {
        "a1": {"o": (d["ring"] * 0.0, d["ring"] * 1.0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "a2": {"o": (d["ring"] * -0.866025403784, d["ring"] * -0.5, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "a3": {"o": (d["ring"] * 0.866025403784, d["ring"] * -0.5, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "shaft": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
