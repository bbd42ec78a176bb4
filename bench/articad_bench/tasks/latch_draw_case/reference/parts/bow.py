from build123d import Box, Cylinder, Pos, Rot


def build(part):
    d = part.dimensions
    inside, leg, eye, bore, reach = d["inside"], d["leg"], d["eye"], d["bore"], d["reach"]
    height = d["height"]
    shape = Pos(reach, 0, 0) * Box(height, inside + 2 * leg, height)
    for side in (-1, 1):
        y = side * (inside + leg) / 2
        shape += Pos(reach / 2, y, 0) * Box(reach, leg, height) + Pos(0, y, 0) * Rot(X=90) * Cylinder(eye / 2, leg)
    shape -= Rot(X=90) * Cylinder(bore / 2, 4 * inside)
    return shape, {"lever": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)}}
