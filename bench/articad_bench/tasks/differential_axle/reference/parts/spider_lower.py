from build123d import Align, Cone, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    shape = Pos(0, 0, d["near"]) * Cone(d["tip_r"] - 0.4, d["side_r"] - 0.4, d["far"] - d["near"], align=LOW) - Cylinder(d["bore"], 1000)
    shape = Rot(X=180) * shape
    return shape, {
        "pin": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
