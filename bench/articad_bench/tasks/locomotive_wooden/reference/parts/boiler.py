from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    diameter, length, flat = d["diameter"], d["length"], d["flat"]
    shape = Pos(length / 2, 0, diameter / 2 - flat) * Rot(Y=90) * Cylinder(diameter / 2, length)
    shape -= Pos(length / 2, 0, 0) * Box(2 * length, 2 * diameter, 4 * flat, align=HIGH)
    shape -= Pos(0.75 * length, 0, diameter - flat - 2) * Box(18, 18, 10, align=LOW)
    return shape, {
        "chassis": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "chimney": {"o": (0.75*length, 0, diameter - flat - 2), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
