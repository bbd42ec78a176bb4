from build123d import Align, Axis, Box, Plane, Polyline, Pos, make_face, revolve


def build(part):
    d = part.dimensions
    nose, end, low, high = d["nose_radius"], d["nose_end"], d["flange_low"], d["flange_high"]
    f, body, cz, c, top, tz = (
        d["flange_radius"], d["body_radius"], d["collar_z"], d["collar_radius"], d["top_radius"], d["top_z"]
    )
    ct = cz + d["collar_height"]
    outline = Polyline(
        (0, -end), (nose, -end), (nose, -low), (f, -low), (f, -high), (body, -high), (body, cz), (c, cz),
        (c, ct), (top, ct), (top, tz), (0, tz), close=True,
    )
    shape = revolve(Plane.XZ * make_face(outline), axis=Axis.Z, revolution_arc=360)
    shape += Pos(0, 0, d["key_z"]) * Box(
        d["key_depth"], d["key_width"], tz - d["key_z"], align=(Align.MIN, Align.CENTER, Align.MIN)
    )
    return shape, {
        "axis": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "nose": {"o": (0, 0, -end), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
