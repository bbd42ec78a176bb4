from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    shape = Pos(0, 0, d["low"]) * Cylinder(d["radius"], d["thickness"], align=LOW)
    return FRONT * shape, {
        "face": {"o": (0, -d["low"], 0), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
