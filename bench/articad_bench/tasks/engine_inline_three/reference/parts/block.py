from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    shape = Pos(0, (d["low"] + d["high"]) / 2, 0) * Box(2 * d["half"], d["high"] - d["low"], 2 * d["end"] + 2 * d["wall_t"])
    for side in (-1, 1):
        shape += Pos(0, (d["high"] - d["sump"]) / 2, side * (d["end"] + d["wall_t"] / 2)) * Box(2 * d["half"], d["high"] + d["sump"], d["wall_t"])
    for i in (-1, 0, 1):
        shape -= Pos(0, 0, i * d["pitch"]) * Rot(X=-90) * Cylinder(d["bore_r"], 1000, align=LOW) + Pos(0, d["low"], i * d["pitch"]) * Box(2 * d["bore_r"] + 8, 28, d["slot"])
    shape -= Cylinder(d["main_bore"], 1000)
    return FRONT * shape, {
        "shaft": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "cylinder_1": {"o": (0, -(-d["pitch"]), 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "cylinder_2": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "cylinder_3": {"o": (0, -d["pitch"], 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
