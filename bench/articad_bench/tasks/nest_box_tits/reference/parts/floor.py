from build123d import Align, Box, Cylinder, GridLocations

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    side, thickness, hole, apart = d["side"], d["thickness"], d["hole"], d["apart"]
    shape = Box(side, side, thickness, align=LOW) - GridLocations(apart, 0, 2, 1) * Cylinder(hole / 2, 4 * thickness)
    return shape, {
        "left": {"o": (-side/2, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "right": {"o": (side/2, 0, 0), "z": (0, 0, 1), "x": (-1, 0, 0)},
        "front": {"o": (0, -side/2, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "back": {"o": (0, side/2, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
