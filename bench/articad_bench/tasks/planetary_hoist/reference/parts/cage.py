from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    shape = Pos(0, 0, d["low"]) * Cylinder(d["radius"], d["thickness"], align=LOW)
    shape += Pos(0, 0, d["low"] + d["thickness"]) * Cylinder(d["drum_r"], d["drum_h"], align=LOW)
    shape += Pos(0, 0, d["low"] + d["thickness"] + d["drum_h"] - d["flange"]) * Cylinder(d["drum_r"] + 2 * d["flange"], d["flange"], align=LOW)
    shape += Pos(d["p1_u"], d["p1_v"], 0) * Cylinder(d["pin_r"], d["low"] + d["thickness"] / 2 - (0), align=LOW)
    shape += Pos(d["p2_u"], d["p2_v"], 0) * Cylinder(d["pin_r"], d["low"] + d["thickness"] / 2 - (0), align=LOW)
    shape += Pos(d["p3_u"], d["p3_v"], 0) * Cylinder(d["pin_r"], d["low"] + d["thickness"] / 2 - (0), align=LOW)
    return shape, {
        "o": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "p1": {"o": (d["p1_u"], d["p1_v"], 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "p2": {"o": (d["p2_u"], d["p2_v"], 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "p3": {"o": (d["p3_u"], d["p3_v"], 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
