from build123d import Align, Box, Cylinder, Pos, Rot

HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    shape = Pos(0, 0, -d["root"]) * Cylinder(d["plat_r"] + 2 * d["half"], d["plate"], align=HIGH)
    for i in range(3):
        for s in (-1, 1):
            shape += Rot(Z=120 * i) * (Pos(d["plat_r"], s * (d["core"] + d["prong"] / 2), -d["root"] / 2 - 0.5) * Box(2 * d["half"], d["prong"], d["root"] + 1) + Pos(d["plat_r"], s * (d["core"] + d["prong"] / 2), 0) * Rot(X=90) * Cylinder(d["half"], d["prong"]))
    for i in range(3):
        shape -= Rot(Z=120 * i) * Pos(d["plat_r"], 0, 0) * Rot(X=90) * Cylinder(d["bore"], 4 * d["half"] + 2 * d["core"])
    return shape, {
        "leg_1": {"o": (d["plat_r"] * 1.0, 0, 0), "z": (-0.0, 1.0, 0), "x": (1.0, 0.0, 0)},
        "leg_2": {"o": (d["plat_r"] * -0.5, d["plat_r"] * 0.866025403784, 0), "z": (-0.866025403784, -0.5, 0), "x": (-0.5, 0.866025403784, 0)},
        "leg_3": {"o": (d["plat_r"] * -0.5, d["plat_r"] * -0.866025403784, 0), "z": (0.866025403784, -0.5, 0), "x": (-0.5, -0.866025403784, 0)},
    }
