from build123d import Align, Box, GridLocations, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length, depth, height, wall, foot, floor = d["length"], d["depth"], d["height"], d["wall"], d["foot"], d["floor"]
    rail = d["rail"]
    shape = Pos(0, 0, foot) * Box(length, depth, height - foot, align=LOW)
    shape -= Pos(0, 0, floor + wall) * Box(length - 2 * wall, depth - 2 * wall, height, align=LOW)
    shape -= Pos(0, -depth / 2, foot + wall) * Box(length - 2 * wall, depth - wall, floor - foot - wall, align=(Align.CENTER, Align.MIN, Align.MIN))
    shape += GridLocations(length - foot, depth - foot, 2, 2) * Box(foot, foot, foot, align=LOW)
    return shape, {
        "hinge": {"o": (0, depth/2, height), "z": (1, 0, 0), "x": (0, 1, 0)},
        "drawer": {"o": (0, -depth/2, foot+wall), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
