from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    shape = Pos(-d["skirt"], 0, d["wm"]) * Rot(Y=90) * Cylinder(d["radius"], d["skirt"] + d["crown"], align=LOW)
    shape -= Pos(-d["skirt"], 0, d["wm"]) * Box(2 * d["skirt"] + 14, 100, d["slot"])
    shape += Pos(0, 0, d["wm"]) * Cylinder(d["pin_r"], 1.6 * d["radius"])
    return FRONT * shape, {
        "axis": {"o": (0, -d["wm"], 0), "z": (1, 0, 0), "x": (0, -1, 0)},
        "n2": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
