from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    shape = Cylinder(d["disc_r"], d["thickness"], align=LOW) - Cylinder(d["shaft_bore"], 100)
    shape += Pos(d["throw"], 0, 0) * Cylinder(d["pin_r"], d["pin_top"] + 3, align=LOW)
    shape += Pos(d["throw"], 0, d["pin_top"]) * Cylinder(d["pin_r"] + 2.5, 3, align=LOW)  # keeps the block
    return FRONT * shape, {
        "shaft": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "pin": {"o": (d["throw"], 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
