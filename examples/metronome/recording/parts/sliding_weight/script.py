from build123d import Box, Plane, Polyline, extrude, make_face


def build(part):
    d = part.dimensions
    half, low, high = d["height"] / 2, d["bottom_half"], d["top_half"]
    outline = make_face(Polyline((-low, -half), (low, -half), (high, half), (-high, half), close=True))
    shape = extrude(Plane.XZ * outline, amount=d["thickness"] / 2, both=True)
    shape -= Box(d["slot_width"], d["slot_thickness"], d["height"] + 2)
    return shape, {"slot": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
