from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    width, height, thickness, hole, hole_z = d["width"], d["height"], d["thickness"], d["hole"], d["hole_z"]
    shape = Pos(thickness / 2, 0, 0) * Box(thickness, width, height, align=LOW)
    shape -= Pos(0, 0, hole_z) * Rot(Y=90) * Cylinder(hole / 2, 4 * thickness)
    return shape, {
        "bottom": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "dowel": {"o": (0, 0, hole_z), "z": (1, 0, 0), "x": (0, 1, 0)},
    }
