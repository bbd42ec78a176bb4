from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length, width, thickness, inside, ear = d["length"], d["width"], d["thickness"], d["inside"], d["ear"]
    axis_z, ear_radius, pin = d["axis_z"], d["ear_radius"], d["pin"]
    shape = Box(length, width, thickness, align=LOW)
    for side in (-1, 1):
        y = side * (inside + ear) / 2
        shape += Pos(0, y, 0) * Box(2 * ear_radius, ear, axis_z, align=LOW) + Pos(0, y, axis_z) * Rot(X=90) * Cylinder(ear_radius, ear)
    shape += Pos(0, 0, axis_z) * Rot(X=90) * Cylinder(pin / 2, inside + 2 * ear)
    return shape, {
        "board": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "lever": {"o": (0, 0, axis_z), "z": (0, 1, 0), "x": (1, 0, 0)},
    }
