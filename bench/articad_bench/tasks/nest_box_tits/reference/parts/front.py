from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    width, height, thickness, hole, below_top = d["width"], d["height"], d["thickness"], d["hole"], d["below_top"]
    shape = Pos(0, -thickness / 2, 0) * Box(width, thickness, height, align=LOW)
    shape -= Pos(0, 0, height - below_top) * Rot(X=90) * Cylinder(hole / 2, 4 * thickness)
    return shape, {"floor": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}, "roof": {"o": (0, 0, height), "z": (0, 0, 1), "x": (1, 0, 0)}}
