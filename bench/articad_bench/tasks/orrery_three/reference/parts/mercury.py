from build123d import Align, Box, Cylinder, Pos, Sphere

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    shape = Pos(0, 0, d["low"]) * Cylinder(d["wheel_r"], d["thickness"], align=LOW)
    shape += Pos(d["arm"] / 2, 0, d["low"] + d["thickness"] / 2) * Box(d["arm"], 5, d["thickness"])
    shape += Pos(d["arm"], 0, d["low"]) * Cylinder(2.5, d["rise"], align=LOW)
    shape += Pos(d["arm"], 0, d["low"] + d["rise"] + d["ball"] / 2) * Sphere(d["ball"])
    shape -= Cylinder(d["bore"], 1000)
    return shape, {
        "o": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
