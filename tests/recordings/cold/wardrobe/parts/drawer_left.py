from build123d import Align, Box, Pos

LOW = (Align.MIN, Align.MIN, Align.MIN)


def block(x0, x1, y0, y1, z0, z1):
    return Pos(x0, y0, z0) * Box(x1 - x0, y1 - y0, z1 - z0, align=LOW)


def build(part):
    d = part.dimensions
    lap = 1.0
    t = d["front_thickness"]
    end = t + d["box_length"]
    half = d["box_width"] / 2
    z0, z1 = d["box_z"], d["box_z"] + d["box_height"]
    wall = d["wall"]

    box = block(-half, half, t - lap, end, z0, z1)
    box -= block(-half + wall, half - wall, t, end - wall, z0 + d["bottom"], z1 + 1)

    drawer = block(-d["front_outer"], d["front_inner"], 0, t, 0, d["front_height"]) + box

    bar = d["handle_bar"]
    mx = (d["front_inner"] - d["front_outer"]) / 2
    mz = d["front_height"] / 2
    x0, x1 = mx - d["handle_length"] / 2, mx + d["handle_length"] / 2
    handle = block(x0, x1, -d["handle_out"], lap, mz - bar / 2, mz + bar / 2)
    handle -= block(x0 + bar, x1 - bar, -d["handle_out"] + bar, 2 * lap, mz - bar, mz + bar)
    drawer += handle

    # runner grooves behind the front, open at the rear end
    g0, g1 = d["groove_z"], d["groove_z"] + d["groove_height"]
    depth = d["groove_depth"]
    drawer -= block(-half - 1, -half + depth, t, end + 1, g0, g1)
    drawer -= block(half - depth, half + 1, t, end + 1, g0, g1)

    return drawer, {"slide": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)}}
