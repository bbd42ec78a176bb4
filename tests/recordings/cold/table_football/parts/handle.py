from build123d import Align, Box, Cone, Cylinder, Pos, Rot


def build(part):
    d = part.dimensions
    r, length, c = d["radius"], d["length"], d["end_chamfer"]

    def disc(radius, y0, y1):
        return Pos(0, (y0 + y1) / 2, 0) * Rot(X=90) * Cylinder(radius, y1 - y0)

    shape = disc(r, -(length - c), 0)
    # Rot(X=90) turns +Z to -Y: the small end of the cone is the outer end
    shape += Pos(0, -(length - c / 2), 0) * Rot(X=90) * Cone(r, r - c, c)

    w = d["groove_width"]
    for k in (-1, 0, 1):
        y = -length / 2 + k * d["groove_spacing"]
        ring = disc(r + 2, y - w / 2, y + w / 2) - disc(r - d["groove_depth"], y - w, y + w)
        shape -= ring

    rs, depth = d["socket_radius"], d["socket_depth"]
    socket = disc(rs, -depth, 1)
    socket -= Pos(0, 0, d["flat_height"]) * Box(
        2 * rs + 2, 2 * depth + 4, rs + 1, align=(Align.CENTER, Align.CENTER, Align.MIN)
    )
    shape -= socket
    return shape, {"seat": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)}}
