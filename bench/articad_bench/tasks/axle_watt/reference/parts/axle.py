from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    shape = Pos(0, 0, d["ws"]) * Rot(Y=90) * Cylinder(d["tube_r"], 2 * d["half"]) + Pos(0, 0, d["low"]) * Cylinder(d["pin_r"], d["ws"] - d["low"], align=LOW)
    for side in (-1, 1):
        shape += Pos(side * d["half"], 0, d["ws"]) * Rot(Y=90) * Cylinder(d["hub_r"], d["hub"])
    return FRONT * shape, {
        "p": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
