from build123d import Align, Box, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    thickness, width, bottom, top, hole = d["thickness"], d["width"], d["bottom"], d["top"], d["hole"]
    depth = d["depth"]
    shape = Pos(0, 0, bottom) * Box(thickness, width, top - bottom, align=LOW)
    shape -= Pos(0, 0, top) * Cylinder(hole / 2, depth, align=HIGH)
    return shape, {"slide": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
