from build123d import Align, Box, Cylinder, GridLocations

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length, width, thickness, hole, pattern_x = d["length"], d["width"], d["thickness"], d["hole"], d["pattern_x"]
    pattern_y = d["pattern_y"]
    shape = Box(length, width, thickness, align=LOW) - GridLocations(pattern_x, pattern_y, 2, 2) * Cylinder(hole / 2, 4 * thickness)
    return shape, {
        "tray": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "screw_1": {"o": (pattern_x/2, pattern_y/2, thickness), "z": (0, 0, 1), "x": (1, 0, 0)},
        "screw_2": {"o": (-pattern_x/2, pattern_y/2, thickness), "z": (0, 0, 1), "x": (1, 0, 0)},
        "screw_3": {"o": (-pattern_x/2, -pattern_y/2, thickness), "z": (0, 0, 1), "x": (1, 0, 0)},
        "screw_4": {"o": (pattern_x/2, -pattern_y/2, thickness), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
