from build123d import Align, Box, Pos


def build(part):
    d = part.dimensions
    t = d["thickness"]
    shape = Box(2 * d["half_x"], t, d["height"], align=(Align.CENTER, Align.MAX, Align.MIN))
    for i in range(d["tick_count"]):
        z = d["first_tick_z"] + i * d["tick_pitch"]
        for side in (-1, 1):
            x = side * (d["tick_inner_x"] + d["tick_length"] / 2)
            shape -= Pos(x, -t - 1, z) * Box(
                d["tick_length"], 1 + d["tick_depth"], d["tick_height"], align=(Align.CENTER, Align.MIN, Align.CENTER))
    return shape, {"seat": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)}}
