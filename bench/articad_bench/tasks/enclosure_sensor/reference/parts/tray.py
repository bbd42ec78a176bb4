from build123d import Align, Box, Cylinder, GridLocations, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length, width, height, wall, boss = d["length"], d["width"], d["height"], d["wall"], d["boss"]
    screw, pilot_depth, pattern_x, pattern_y, cable = d["screw"], d["pilot_depth"], d["pattern_x"], d["pattern_y"], d["cable"]
    shape = Box(length, width, height, align=LOW) - Pos(0, 0, wall) * Box(length - 2 * wall, width - 2 * wall, height, align=LOW)
    corners = GridLocations(pattern_x, pattern_y, 2, 2)
    shape += corners * Cylinder(boss / 2, height, align=LOW)
    shape -= Pos(0, 0, height - pilot_depth) * corners * Cylinder(screw / 2 - 0.25, height, align=LOW)
    shape -= Pos(length / 2, 0, height / 2) * Rot(Y=90) * Cylinder(cable / 2, 4 * wall)
    return shape, {
        "screw_1": {"o": (pattern_x/2, pattern_y/2, height), "z": (0, 0, 1), "x": (1, 0, 0)},
        "lid": {"o": (0, 0, height), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
