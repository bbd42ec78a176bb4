from build123d import Box, Cylinder, Pos, Rot


def block(x0, x1, y0, y1, z0, z1):
    return Pos((x0 + x1) / 2, (y0 + y1) / 2, (z0 + z1) / 2) * Box(x1 - x0, y1 - y0, z1 - z0)


def build(part):
    d = part.dimensions
    half, front, back, top = d["body_half"], d["body_front"], d["body_back"], d["body_top"]
    inside, outside = d["prong_inner"], d["prong_outer"]
    root = (back - front) / 2  # the prongs reach into the body
    shape = block(-half, half, -front, back, -d["body_below"], top)
    for x0, x1 in ((inside, outside), (-outside, -inside)):
        shape += block(x0, x1, -d["prong_end"], root, d["prong_bottom"], top)
    shape += Rot(Y=90) * Cylinder(d["shaft_radius"], 2 * d["shaft_half"])
    return shape, {"axis": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, -1, 0)}}
