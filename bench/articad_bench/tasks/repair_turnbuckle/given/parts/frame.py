from build123d import Box, Cylinder, Rot


def build(part):
    d = part.dimensions
    length, head, width, bar, height = d["length"], d["head"], d["width"], d["bar"], d["height"]
    bore = d["bore"]
    shape = Box(length, width, height) - Box(length - 2 * head, width - 2 * bar, 2 * height)
    shape -= Rot(Y=90) * Cylinder(bore / 2, 2 * length)
    return shape, {
        "left": {"o": (-length/2 + head/2, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)},
        "right": {"o": (length/2 - head/2, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)},
    }
