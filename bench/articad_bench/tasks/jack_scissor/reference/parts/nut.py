from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    shape = Pos(0, 0, d["low"]) * Box(d["size"], d["size"], d["thickness"], align=LOW) + Cylinder(d["pin_r"], d["low"] + 1, align=LOW)
    shape -= Pos(0, 0, d["ws"]) * Rot(Y=90) * Cylinder(d["hole_r"], 1000)
    return FRONT * shape, {
        "screw": {"o": (0, -d["ws"], 0), "z": (1, 0, 0)},
        "l": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
