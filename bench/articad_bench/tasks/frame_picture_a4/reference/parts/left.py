from build123d import Box, Plane, Polygon, Pos, extrude


def build(part):
    d = part.dimensions
    length, width, thickness, rebate, rebate_depth = d["length"], d["width"], d["thickness"], d["rebate"], d["rebate_depth"]
    rail = Plane.XZ * Polygon((0, 0), (width, width), (width, length - width), (0, length), align=None)
    shape = extrude(rail, -thickness)
    shape -= Pos(width, thickness, length / 2) * Box(2 * rebate, 2 * rebate_depth, 2 * length)
    return shape, {"bottom": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}, "top": {"o": (0, 0, length), "z": (0, 0, 1), "x": (1, 0, 0)}}
