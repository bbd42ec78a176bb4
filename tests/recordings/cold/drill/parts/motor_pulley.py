from build123d import Align, Axis, Cylinder, Plane, Polyline, Pos, make_face, revolve


def build(part):
    d = part.dimensions
    f, h, gh, g = d["flange_radius"], d["half_height"], d["groove_half"], d["groove_radius"]
    s, end = d["shaft_radius"], d["shaft_end"]
    outline = Polyline(
        (0, -end), (s, -end), (s, -h), (f, -h), (f, -gh), (g, -gh), (g, gh), (f, gh), (f, h), (0, h), close=True
    )
    shape = revolve(Plane.XZ * make_face(outline), axis=Axis.Z, revolution_arc=360)
    depth = d["hole_depth"]
    shape -= Pos(d["hole_x"], 0, h - depth) * Cylinder(
        d["hole_radius"], depth + 1, align=(Align.CENTER, Align.CENTER, Align.MIN)
    )
    return shape, {"shaft": {"o": (0, 0, d["seat_z"]), "z": (0, 0, 1), "x": (1, 0, 0)}}
