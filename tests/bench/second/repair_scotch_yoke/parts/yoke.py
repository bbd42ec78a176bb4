from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    shape = Pos(0, 0, d["low"]) * Box(d["slot"] + 2 * d["wall"], 2 * d["rod_v"] + d["lug"], d["thickness"], align=LOW)
    for v in (-d["rod_v"], d["rod_v"]):
        shape += Pos(0, v, d["rod_w"]) * Box(d["slot"] + 2 * d["wall"], d["lug"], 1.3 * d["lug"])
    shape -= Pos(0, 0, d["low"] - 1) * Box(d["slot"], 2 * d["half_h"], d["thickness"] + 2, align=LOW)
    for v in (-d["rod_v"], d["rod_v"]):
        shape -= Pos(0, v, d["rod_w"]) * Rot(Y=90) * Cylinder(d["bore_r"], 1000)
    shape += Pos(d["slot"] / 2 + d["wall"] / 2, 0, d["low"] + d["thickness"] / 2 + d["plunger_r"]) * Rot(Y=90) * Cylinder(d["plunger_r"], d["plunger_end"] - d["slot"] / 2 - d["wall"] / 2, align=LOW)
    return FRONT * shape, {
        "lugs": {"o": (0, -d["rod_w"], 0), "z": (1, 0, 0), "x": (0, -1, 0)},
        "slot": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
