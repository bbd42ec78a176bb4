from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    shape = Pos(0, 0, d["low"]) * Cylinder(d["eye"], d["thickness"], align=LOW)
    shape += Pos(d["eye"] / 2, 0, d["low"] + d["thickness"] / 2) * Rot(Y=90) * Cylinder(d["outer_r"], d["length"] - d["eye"] / 2, align=LOW)
    shape -= Pos(1.5 * d["eye"], 0, d["low"] + d["thickness"] / 2) * Rot(Y=90) * Cylinder(d["rod_bore"], d["length"], align=LOW)
    shape -= Pos(0, 0, 0) * Cylinder(d["bore_r"], 1000)
    return FRONT * shape, {
        "axis": {"o": (0, -(d["low"] + d["thickness"] / 2), 0), "z": (1, 0, 0), "x": (0, -1, 0)},
        "w": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
