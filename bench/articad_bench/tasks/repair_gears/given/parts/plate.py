from build123d import Align, Box, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length, width, thickness, pin, pin_height = d["length"], d["width"], d["thickness"], d["pin"], d["pin_height"]
    apart = d["apart"]
    shape = Pos(apart / 2 + 9, 0, 0) * Box(length, width, thickness, align=LOW)
    shape += [Pos(x, 0, 0) * Cylinder(pin / 2, pin_height, align=LOW) for x in (0, apart)]
    return shape, {
        "small": {"o": (0, 0, thickness), "z": (0, 0, 1), "x": (1, 0, 0)},
        "large": {"o": (apart, 0, thickness), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
