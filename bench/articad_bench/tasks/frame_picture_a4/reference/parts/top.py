from build123d import Box, Plane, Polygon, Pos, extrude


def build(part):
    d = part.dimensions
    length, width, thickness, rebate, rebate_depth = d["length"], d["width"], d["thickness"], d["rebate"], d["rebate_depth"]
    rail = Plane.XZ * Polygon((0, 0), (width, -width), (length - width, -width), (length, 0), align=None)
    shape = extrude(rail, -thickness)
    shape -= Pos(length / 2, thickness, -width) * Box(2 * length, 2 * rebate_depth, 2 * rebate)
    return shape, {"left": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
