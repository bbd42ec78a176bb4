from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    shape = Pos(0, 0, -d["end"]) * Cylinder(d["main_r"], 2 * d["end"], align=LOW)
    for i in (-1, 0, 1):
        gap = Pos(0, 0, i * d["pitch"]) * Cylinder(2 * d["web_r"], d["journal"])
        shape -= gap
        shape += Pos(0, 0, i * d["pitch"] + d["journal"] / 2) * Cylinder(d["web_r"], d["web"], align=LOW) + Pos(0, 0, i * d["pitch"] - d["journal"] / 2) * Cylinder(d["web_r"], d["web"], align=HIGH)
    for i in (-1, 0, 1):
        shape += Rot(Z=120 * (i + 1)) * Pos(d["throw"], 0, i * d["pitch"]) * Cylinder(d["journal_r"], d["journal"] + 2)
    return FRONT * shape, {
        "shaft": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "pin_1": {"o": (d["throw"] * 1.0, -(-d["pitch"]), 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "pin_2": {"o": (d["throw"] * -0.5, 0, d["throw"] * 0.866025403784), "z": (0, -1, 0), "x": (1, 0, 0)},
        "pin_3": {"o": (d["throw"] * -0.5, -d["pitch"], d["throw"] * -0.866025403784), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
