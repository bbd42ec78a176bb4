from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    shape = Pos(0, 0, d["low"]) * Box(d["across"], d["along"], d["thickness"], align=LOW)
    shape -= Pos(0, 0, d["low"] + d["thickness"] / 2) * Rot(X=90) * Cylinder(d["rod_bore"], 1000)
    shape += Pos(0, 0, d["t_low"]) * Cylinder(d["pin_r"], d["low"] + 0.5 - (d["t_low"]), align=LOW)
    return FRONT * shape, {
        "guide": {"o": (0, -(d["low"] + d["thickness"] / 2), 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "t": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
