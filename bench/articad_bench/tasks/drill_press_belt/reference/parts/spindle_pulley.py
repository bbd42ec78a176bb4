from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    shape = Pos(0, 0, d["thickness"]) * Cylinder(d["radius"], d["thickness"], align=LOW) + Cylinder(d["hub"], d["thickness"] + 1, align=LOW)
    shape -= Cylinder(d["bore"], 1000) + Pos(d["radius"], 0, 0) * Cylinder(d["mark"], 1000)
    return shape, {
        "axis": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
