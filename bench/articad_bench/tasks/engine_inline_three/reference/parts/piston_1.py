from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    shape = Pos(0, -d["skirt"], 0) * Rot(X=-90) * Cylinder(d["radius"], d["skirt"] + d["crown"], align=LOW)
    shape -= Pos(0, d["roof"], 0) * Box(100, 200, d["slot"], align=(Align.CENTER, Align.MAX, Align.CENTER))
    shape += Cylinder(d["pin_r"], 1.7 * d["radius"])
    return FRONT * shape, {
        "pin": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "axis": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
