from build123d import Box


def build(part):
    d = part.dimensions
    length, width, height, wheel_x = d["length"], d["width"], d["height"], d["wheel_x"]
    shape = Box(length, width, height)
    return shape, {
        "boiler": {"o": (length/2 - 98, 0, height/2), "z": (0, 0, 1), "x": (1, 0, 0)},
        "cab": {"o": (-length/2 + 30, 0, height/2), "z": (0, 0, 1), "x": (1, 0, 0)},
        "wheel_1": {"o": (wheel_x, width/2, 0), "z": (0, 1, 0), "x": (1, 0, 0)},
        "wheel_2": {"o": (-wheel_x, width/2, 0), "z": (0, 1, 0), "x": (1, 0, 0)},
        "wheel_3": {"o": (wheel_x, -width/2, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "wheel_4": {"o": (-wheel_x, -width/2, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
