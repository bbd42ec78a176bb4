from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    shape = Pos(0, 0, -d["play"]) * Cylinder(d["dial_r"], d["board"], align=HIGH) + Pos(0, 0, -d["play"] - 1) * Cylinder(d["arbor_r"], d["arbor_top"] + d["play"] + 1, align=LOW)
    for i in range(12):
        shape -= Rot(Z=30 * i) * Pos(d["dial_r"] - 3 * d["pip"], 0, 0) * Cylinder(d["pip"], 1000)
    return FRONT * shape, {
        "hour": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "minute": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "second": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
