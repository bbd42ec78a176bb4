from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    shape = Pos(0, 0, d["low"]) * Cylinder(d["disc_r"], d["thickness"], align=LOW)
    shape += Pos(0, 0, d["low"] + d["thickness"] - 1) * Cylinder(d["shaft_r"], d["shaft"] + 1, align=LOW)
    shape += Pos(d["ring"] * 0.0, d["ring"] * 1.0, d["c1_low"]) * Cylinder(d["pin_r"], d["low"] + d["thickness"] / 2 - (d["c1_low"]), align=LOW)
    shape += Pos(d["ring"] * -0.866025403784, d["ring"] * -0.5, d["c2_low"]) * Cylinder(d["pin_r"], d["low"] + d["thickness"] / 2 - (d["c2_low"]), align=LOW)
    shape += Pos(d["ring"] * 0.866025403784, d["ring"] * -0.5, d["c3_low"]) * Cylinder(d["pin_r"], d["low"] + d["thickness"] / 2 - (d["c3_low"]), align=LOW)
    return shape, {
        "c1": {"o": (d["ring"] * 0.0, d["ring"] * 1.0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "c2": {"o": (d["ring"] * -0.866025403784, d["ring"] * -0.5, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "c3": {"o": (d["ring"] * 0.866025403784, d["ring"] * -0.5, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "shaft": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
