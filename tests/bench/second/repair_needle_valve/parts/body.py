from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    diameter, height, passage, seat, bore = d["diameter"], d["height"], d["passage"], d["seat"], d["bore"]
    side_z = d["side_z"]
    shape = Cylinder(diameter / 2, height, align=LOW)
    shape -= Cylinder(passage / 2, seat + 1, align=LOW) + Pos(0, 0, seat) * Cylinder(bore / 2, 2 * height, align=LOW)
    shape -= Pos(0, 0, side_z) * Rot(Y=90) * Cylinder(passage / 2, diameter, align=LOW)
    return shape, {
        "needle": {"o": (0, 0, height), "z": (0, 0, 1), "x": (1, 0, 0)},
        "nut": {"o": (0, 0, height), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
