from build123d import Box, Cylinder, Plane, Polyline, Pos, Rot, extrude, make_face


def block(x0, x1, y0, y1, z0, z1):
    return Pos((x0 + x1) / 2, (y0 + y1) / 2, (z0 + z1) / 2) * Box(x1 - x0, y1 - y0, z1 - z0)


def build(part):
    d = part.dimensions
    thickness, height = d["thickness"], d["height"]
    wide, narrow = d["bottom_half"], d["top_half"]
    outline = make_face(Polyline((-wide, 0), (wide, 0), (narrow, height), (-narrow, height), close=True))
    shape = Pos(0, -thickness / 2, 0) * extrude(Plane.XZ * outline, amount=thickness / 2, both=True)

    # lugs
    lug_y, lug_z, radius = d["lug_y"], d["lug_z"], d["lug_radius"]
    for x0, x1 in ((d["lug_inner"], d["lug_outer"]), (-d["lug_outer"], -d["lug_inner"])):
        disc = Pos((x0 + x1) / 2, -lug_y, lug_z) * Rot(Y=90) * Cylinder(radius, x1 - x0)
        shape += disc + block(x0, x1, -lug_y, -thickness / 2, lug_z - radius, lug_z + radius)
    shape -= Pos(0, -lug_y, lug_z) * Rot(Y=90) * Cylinder(d["bore_radius"], 2 * d["lug_outer"] + 2)

    # engraved tempo lines
    line_in, line_out, half = d["line_inner"], d["line_outer"], d["line_height"] / 2
    floor = -thickness + d["line_depth"]
    for name in sorted(d):
        if name.startswith("tempo_"):
            m = d[name]
            shape -= block(line_in, line_out, -thickness - 1, floor, m - half, m + half)
            shape -= block(-line_out, -line_in, -thickness - 1, floor, m - half, m + half)

    connectors = {
        "seat": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "latch": {"o": (0, -lug_y, lug_z), "z": (1, 0, 0), "x": (0, -1, 0)},
    }
    return shape, connectors
