from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    shape = Pos(0, 0, d["low"]) * Cylinder(d["eye"], d["thickness"], align=LOW)
    shape += Pos(-d["length"], 0, d["low"] + d["thickness"] / 2) * Rot(Y=90) * Cylinder(d["rod_r"], d["length"], align=LOW)
    shape -= Pos(0, 0, 0) * Cylinder(d["bore_r"], 1000)
    return FRONT * shape, {
        "axis": {"o": (0, -(d["low"] + d["thickness"] / 2), 0), "z": (1, 0, 0), "x": (0, -1, 0)},
        "v": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
