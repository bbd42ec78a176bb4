from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    shape = Pos(0, 0, d["low"]) * Cylinder(d["disc_r"], d["thickness"], align=LOW)
    shape += Pos(d["ring"] * 0.0, d["ring"] * 1.0, d["low"] + d["thickness"] / 2) * Cylinder(d["pin_r"], d["b1_high"] - (d["low"] + d["thickness"] / 2), align=LOW)
    shape += Pos(d["ring"] * 0.0, d["ring"] * 1.0, d["b1_low"]) * Cylinder(d["pin_r"], d["low"] + d["thickness"] / 2 - (d["b1_low"]), align=LOW)
    shape += Pos(d["ring"] * -0.866025403784, d["ring"] * -0.5, d["low"] + d["thickness"] / 2) * Cylinder(d["pin_r"], d["b2_high"] - (d["low"] + d["thickness"] / 2), align=LOW)
    shape += Pos(d["ring"] * -0.866025403784, d["ring"] * -0.5, d["b2_low"]) * Cylinder(d["pin_r"], d["low"] + d["thickness"] / 2 - (d["b2_low"]), align=LOW)
    shape += Pos(d["ring"] * 0.866025403784, d["ring"] * -0.5, d["low"] + d["thickness"] / 2) * Cylinder(d["pin_r"], d["b3_high"] - (d["low"] + d["thickness"] / 2), align=LOW)
    shape += Pos(d["ring"] * 0.866025403784, d["ring"] * -0.5, d["b3_low"]) * Cylinder(d["pin_r"], d["low"] + d["thickness"] / 2 - (d["b3_low"]), align=LOW)
    return shape, {
        "b1": {"o": (d["ring"] * 0.0, d["ring"] * 1.0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "b2": {"o": (d["ring"] * -0.866025403784, d["ring"] * -0.5, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "b3": {"o": (d["ring"] * 0.866025403784, d["ring"] * -0.5, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
