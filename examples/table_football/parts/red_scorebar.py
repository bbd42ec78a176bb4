from build123d import Align, Box, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    size, z, half, post = d["bar_size"], d["bar_z"], d["half_length"], d["post_width"]
    bar = Pos(0, 0, z) * Box(size, 2 * half, size)
    pitch = 2 * half / (d["notch_count"] + 1)
    for i in range(d["notch_count"]):
        bar -= Pos(0, (i + 1) * pitch - half, z + size / 2) * Rot(X=45) * Box(2 * size, 0.8, 0.8)
    for side in (-1, 1):
        bar += Pos(0, side * (half + post / 2), 0) * Box(post, post, z + size, align=LOW)
    return bar, {
        "foot": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (-1, 0, 0)},
        "bar": {"o": (0, 0, z), "z": (0, 1, 0), "x": (-1, 0, 0)},
    }
