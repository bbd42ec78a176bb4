from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    shape = Pos(0, 0, d["low"]) * Box(d["width"], d["height"], d["thickness"], align=LOW) - Cylinder(d["bore_r"], 100)
    return FRONT * shape, {
        "bore": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "cheeks": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
