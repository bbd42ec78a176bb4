from build123d import Box, Cylinder, Plane, Polyline, Pos, Rot, extrude, make_face


def block(x0, x1, y0, y1, z0, z1):
    return Pos((x0 + x1) / 2, (y0 + y1) / 2, (z0 + z1) / 2) * Box(x1 - x0, y1 - y0, z1 - z0)


def frustum(half0, half1, z0, z1, reach):
    """Square frustum: half side half0 at z0, half1 at z1."""
    outline = make_face(Polyline((-half0, z0), (half0, z0), (half1, z1), (-half1, z1), close=True))
    return extrude(Plane.XZ * outline, amount=reach, both=True) & extrude(Plane.YZ * outline, amount=reach, both=True)


def build(part):
    d = part.dimensions
    size, height, wall = d["bottom_size"], d["height"], d["wall"]
    half_bottom, half_top = size / 2, d["top_size"] / 2
    top, bottom = d["ledge_top"], d["ledge_bottom"]
    slope = (half_bottom - half_top) / height

    def inner(z):
        return half_bottom - wall - slope * z

    # outside, upper front cut away
    shape = frustum(half_bottom, half_top, 0, height, size)
    shape -= block(-size, size, -size, -d["split"], top, height + 1)

    # cavity
    low = frustum(inner(-1), inner(bottom), -1, bottom, size)
    high = frustum(inner(bottom - 1), inner(height - wall), bottom - 1, height - wall, size)
    high &= block(-size, size, d["panel_back"], size, bottom - 2, height)
    shape -= low
    shape -= high

    # knuckles of the cover's hinge
    hinge_y, radius = d["hinge_y"], d["knuckle_radius"]
    inside, outside = d["knuckle_inner"], d["knuckle_outer"]
    for x0, x1 in ((inside, outside), (-outside, -inside)):
        barrel = Pos((x0 + x1) / 2, -hinge_y, top) * Rot(Y=90) * Cylinder(radius, x1 - x0)
        shape += barrel + block(x0, x1, -hinge_y, -d["root_y"], top - radius, top)

    # slot, key hole, pin bores
    shape -= block(-d["slot_half"], d["slot_half"], -d["slot_front"], -d["slot_back"], bottom - 1, top + 1)
    start, end = d["key_hole_start"], d["key_hole_end"]
    shape -= Pos((start + end) / 2, d["key_y"], d["key_z"]) * Rot(Y=90) * Cylinder(d["key_hole_radius"], end - start)
    shape -= Pos(0, -hinge_y, top) * Rot(Y=90) * Cylinder(d["pin_hole_radius"], 2 * outside + 2)

    scale_z = part.connectors["scale"].o[2]
    connectors = {
        "seat": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "hinge_cover": {"o": (0, -hinge_y, top), "z": (1, 0, 0), "x": (0, 1, 0)},
        "pin": {"o": (0, -hinge_y, top), "z": (1, 0, 0), "x": (0, 1, 0)},
        "scale": {"o": (0, -d["split"], scale_z), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
    return shape, connectors
