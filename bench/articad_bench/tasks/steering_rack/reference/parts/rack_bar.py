from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    shape = Pos(0, 0, d["low"]) * Box(d["along"], d["across"], d["thickness"], align=LOW)
    shape -= Pos(0, 0, d["low"] + d["thickness"] / 2) * Rot(Y=90) * Cylinder(d["rod_bore"], 1000)
    shape += Pos(d["p_a"], 0, d["low"] + d["thickness"] - 0.5) * Cylinder(d["pin_r"], d["p_high"] - (d["low"] + d["thickness"] - 0.5), align=LOW)
    shape += Pos(-d["p_a"], 0, d["low"] + d["thickness"] - 0.5) * Cylinder(d["pin_r"], d["q_high"] - (d["low"] + d["thickness"] - 0.5), align=LOW)
    return shape, {
        "guide": {"o": (0, 0, d["low"] + d["thickness"] / 2), "z": (1, 0, 0), "x": (0, 0, 1)},
        "p": {"o": (d["p_a"], 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "q": {"o": (-d["p_a"], 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
