from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    sleeve = Cylinder(d["disc_r"], d["disc_h"])
    for i in range(8):
        sleeve -= Rot(Z=45 * i) * Pos(d["inner"] + d["disc_r"], 0, 0) * Box(2 * d["disc_r"], d["slot"], 2 * d["disc_h"])
    for i in range(8):
        sleeve += Rot(Z=45 * i) * Pos(d["crown_r"], 0, 0) * Rot(X=90) * Cylinder(d["pin_r"], d["slot"] + 2)
    sleeve += Pos(0, 0, -d["collar"]) * Cylinder(d["inner"], d["collar"], align=LOW)
    sleeve -= Cylinder(d["bore"], 1000)
    shape = Rot(X=-90) * sleeve
    return FRONT * shape, {
        "axis": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "pivot_0": {"o": (d["crown_r"] * 1.0, 0, 0), "z": (0.0, -1.0, 0), "x": (1.0, 0, 0)},
        "pivot_1": {"o": (d["crown_r"] * 0.707106781187, -(-d["crown_r"] * 0.707106781187), 0), "z": (0.707106781187, -0.707106781187, 0), "x": (0.707106781187, 0.707106781187, 0)},
        "pivot_2": {"o": (0, -(-d["crown_r"] * 1.0), 0), "z": (1.0, 0, 0), "x": (0.0, 1.0, 0)},
        "pivot_3": {"o": (d["crown_r"] * -0.707106781187, -(-d["crown_r"] * 0.707106781187), 0), "z": (0.707106781187, 0.707106781187, 0), "x": (-0.707106781187, 0.707106781187, 0)},
        "pivot_4": {"o": (d["crown_r"] * -1.0, 0, 0), "z": (0.0, 1.0, 0), "x": (-1.0, 0, 0)},
        "pivot_5": {"o": (d["crown_r"] * -0.707106781187, -(-d["crown_r"] * -0.707106781187), 0), "z": (-0.707106781187, 0.707106781187, 0), "x": (-0.707106781187, -0.707106781187, 0)},
        "pivot_6": {"o": (0, -(-d["crown_r"] * -1.0), 0), "z": (-1.0, 0, 0), "x": (-0.0, -1.0, 0)},
        "pivot_7": {"o": (d["crown_r"] * 0.707106781187, -(-d["crown_r"] * -0.707106781187), 0), "z": (-0.707106781187, -0.707106781187, 0), "x": (0.707106781187, -0.707106781187, 0)},
    }
