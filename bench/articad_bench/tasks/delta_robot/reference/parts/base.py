from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    shape = Pos(0, 0, d["drop"]) * Cylinder(d["radius"], d["board"], align=LOW)
    for i in range(3):
        for s in (-1, 1):
            shape += Rot(Z=120 * i) * (Pos(d["base_r"], s * (d["lug_at"] + d["lug"] / 2), 0) * Box(16, d["lug"], d["drop"] + 1, align=LOW) + Pos(d["base_r"], s * (d["lug_at"] + d["lug"] / 2), 0) * Rot(X=90) * Cylinder(8, d["lug"]))
        shape += Rot(Z=120 * i) * Pos(d["base_r"], 0, 0) * Rot(X=90) * Cylinder(d["pin_r"], 2 * d["lug_at"] + 2)
    return shape, {
        "leg_1": {"o": (d["base_r"] * 1.0, 0, 0), "z": (-0.0, 1.0, 0), "x": (1.0, 0.0, 0)},
        "leg_2": {"o": (d["base_r"] * -0.5, d["base_r"] * 0.866025403784, 0), "z": (-0.866025403784, -0.5, 0), "x": (-0.5, 0.866025403784, 0)},
        "leg_3": {"o": (d["base_r"] * -0.5, d["base_r"] * -0.866025403784, 0), "z": (0.866025403784, -0.5, 0), "x": (-0.5, -0.866025403784, 0)},
    }
