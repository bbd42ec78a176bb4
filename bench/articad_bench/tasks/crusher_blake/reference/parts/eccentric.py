from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    shape = Cylinder(d["wheel_r"], d["thickness"], align=LOW)
    shape -= Pos(0, 0, 0) * Cylinder(d["bore_r"], 1000)
    shape += Pos(d["b_at"], 0, d["thickness"] / 2) * Cylinder(d["pin_r"], d["b_high"] - (d["thickness"] / 2), align=LOW)
    return FRONT * shape, {
        "o": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "b": {"o": (d["b_at"], 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
