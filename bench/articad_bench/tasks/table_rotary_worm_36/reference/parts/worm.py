from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    diameter, length, out, worm, base = d["diameter"], d["length"], d["out"], d["worm"], d["base"]
    worm_length = d["worm_length"]
    shape = Pos(0, 0, -length) * Cylinder(diameter / 2, length + out, align=LOW)
    shape -= Pos(0, 0, -base / 2) * (Cylinder(diameter, worm_length) - Cylinder(worm / 2 - 1, 2 * worm_length))
    return shape, {
        "base": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (0, 1, 0)},
        "wheel": {"o": (0, 0, out - 12), "z": (0, 0, 1), "x": (0, 1, 0)},
    }
