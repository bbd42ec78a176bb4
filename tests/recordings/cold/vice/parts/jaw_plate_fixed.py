from build123d import Align, Box, Pos


def build(part):
    d = part.dimensions
    w, t, n = d["width"], d["thickness"], d["groove_count"]
    shape = Box(w, t, d["height"], align=(Align.CENTER, Align.MAX, Align.CENTER))
    for i in range(n):
        z = (i - (n - 1) / 2) * d["groove_pitch"]
        shape -= Pos(0, -t - 1, z) * Box(
            w + 2, d["groove_depth"] + 1, d["groove_width"],
            align=(Align.CENTER, Align.MIN, Align.CENTER))
    return shape, {"seat": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)}}
