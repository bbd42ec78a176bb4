from build123d import Box, Plane, Polygon, Pos, extrude


def build(part):
    d = part.dimensions
    length, width, thickness, rebate, rebate_depth = d["length"], d["width"], d["thickness"], d["rebate"], d["rebate_depth"]
    rail = Plane.XZ * Polygon((-length / 2, 0), (length / 2, 0), (length / 2 - width, width), (width - length / 2, width), align=None)
    shape = extrude(rail, -thickness)
    shape -= Pos(0, thickness, width) * Box(2 * length, 2 * rebate_depth, 2 * rebate)
    return shape, {
        "left": {"o": (-length/2, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "right": {"o": (length/2, 0, 0), "z": (0, 0, 1), "x": (-1, 0, 0)},
        "glass": {"o": (0, thickness - rebate_depth, width - rebate), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
