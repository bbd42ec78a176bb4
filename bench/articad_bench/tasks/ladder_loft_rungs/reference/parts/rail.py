from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length, width, thickness, hole, first = d["length"], d["width"], d["thickness"], d["hole"], d["first"]
    pitch = d["pitch"]
    shape = Pos(-thickness / 2, 0, 0) * Box(thickness, width, length, align=LOW)
    shape -= [Pos(0, 0, first + i * pitch) * Rot(Y=90) * Cylinder(hole / 2, 4 * thickness) for i in range(5)]
    return shape, {
        "rung_1": {"o": (0, 0, first + 0*pitch), "z": (1, 0, 0), "x": (0, 1, 0)},
        "rung_2": {"o": (0, 0, first + 1*pitch), "z": (1, 0, 0), "x": (0, 1, 0)},
        "rung_3": {"o": (0, 0, first + 2*pitch), "z": (1, 0, 0), "x": (0, 1, 0)},
        "rung_4": {"o": (0, 0, first + 3*pitch), "z": (1, 0, 0), "x": (0, 1, 0)},
        "rung_5": {"o": (0, 0, first + 4*pitch), "z": (1, 0, 0), "x": (0, 1, 0)},
    }
