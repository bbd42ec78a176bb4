from build123d import Align, Cone, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    diameter, tip, cone, point, top = d["diameter"], d["tip"], d["cone"], d["point"], d["top"]
    shape = Pos(0, 0, cone - tip) * Cylinder(diameter / 2, tip - cone + top, align=LOW)
    shape += Pos(0, 0, -tip) * Cone(point / 2, diameter / 2, cone, align=LOW)
    return shape, {
        "body": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "knob": {"o": (0, 0, top - 12), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
