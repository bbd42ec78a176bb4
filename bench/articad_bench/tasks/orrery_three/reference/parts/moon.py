from build123d import Align, Box, Cylinder, Pos, Sphere

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    shape = Cylinder(d["hub"], d["thickness"], align=LOW) + Pos(d["arm"] / 2, 0, d["thickness"] / 2) * Box(d["arm"], 2.4, d["thickness"])
    shape += Pos(d["arm"], 0, d["thickness"] / 2) * Sphere(d["ball"])
    shape -= Cylinder(d["bore"], 1000)
    return shape, {
        "o": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
