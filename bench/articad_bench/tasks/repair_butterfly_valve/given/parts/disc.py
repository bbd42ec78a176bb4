from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    diameter, thickness, shaft, bottom, top = d["diameter"], d["thickness"], d["shaft"], d["bottom"], d["top"]
    neck_top = d["neck_top"]
    shape = Rot(Y=90) * Cylinder(diameter / 2, thickness)
    shape += Pos(0, 0, -bottom) * Cylinder(shaft / 2, bottom + top, align=LOW)
    return shape, {
        "shaft": {"o": (0, 0, neck_top), "z": (0, 0, 1), "x": (1, 0, 0)},
        "lever": {"o": (0, 0, top - 12), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
