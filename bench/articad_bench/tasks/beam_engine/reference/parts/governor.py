from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    shape = Cylinder(d["gov_r"], d["thickness"], align=LOW) - Pos(0.7 * d["gov_r"], 0, 0) * Cylinder(3, 100) + Cylinder(d["boss"], d["thickness"] + 4, align=LOW)
    shape -= Pos(0, 0, 0) * Cylinder(d["bore_r"], 1000)
    return FRONT * shape, {
        "g": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
