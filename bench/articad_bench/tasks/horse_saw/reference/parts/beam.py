from build123d import Align, Box

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length, width, height, apart = d["length"], d["width"], d["height"], d["apart"]
    shape = Box(length, width, height, align=LOW)
    return shape, {
        "leg_1": {"o": (apart/2, width/2, height), "z": (0, 0, 1), "x": (1, 0, 0)},
        "leg_2": {"o": (-apart/2, width/2, height), "z": (0, 0, 1), "x": (1, 0, 0)},
        "leg_3": {"o": (apart/2, -width/2, height), "z": (0, 0, 1), "x": (-1, 0, 0)},
        "leg_4": {"o": (-apart/2, -width/2, height), "z": (0, 0, 1), "x": (-1, 0, 0)},
    }
