from build123d import Align, Box, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    shape = Pos(0, 0, d["low"]) * Cylinder(d["radius"], d["thickness"], align=LOW) + Pos(d["pitch"] - d["lug"] / 2, 0, d["low"] + d["thickness"] - 1) * Box(2 * d["lug"], d["lug"], 5, align=LOW)
    shape += Pos(d["pitch"], 0, d["low"] + d["thickness"]) * Cylinder(d["pin_r"], d["pin_h"], align=LOW)
    shape -= Pos(0, 0, 0) * Cylinder(d["bore_r"], 1000)
    return shape, {
        "p": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "top": {"o": (d["pitch"], 0, d["pen_w"]), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
