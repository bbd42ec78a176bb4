from build123d import Align, Axis, Box, Cylinder, Plane, Polyline, Pos, make_face, revolve


def build(part):
    d = part.dimensions
    f, h, gh, g = d["flange_radius"], d["half_height"], d["groove_half"], d["groove_radius"]
    c, c_end, hub, end = d["collar_radius"], d["collar_end"], d["hub_radius"], d["hub_end"]
    outline = Polyline(
        (0, -end), (hub, -end), (hub, -c_end), (c, -c_end), (c, -h), (f, -h), (f, -gh), (g, -gh),
        (g, gh), (f, gh), (f, h), (0, h), close=True,
    )
    shape = revolve(Plane.XZ * make_face(outline), axis=Axis.Z, revolution_arc=360)
    total = h + end + 2
    shape -= Pos(0, 0, -end - 1) * Cylinder(d["bore_radius"], total, align=(Align.CENTER, Align.CENTER, Align.MIN))
    shape -= Pos(0, 0, -end - 1) * Box(
        d["keyway_depth"], d["keyway_width"], total, align=(Align.MIN, Align.CENTER, Align.MIN)
    )
    return shape, {
        "hub": {"o": (0, 0, d["seat_z"]), "z": (0, 0, 1), "x": (1, 0, 0)},
        "groove": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
