from build123d import Box, Plane, Polyline, extrude, make_face


def build(part):
    d = part.dimensions
    hy, hz, low, high = d["half_y"], d["half_z"], d["half_x_low"], d["half_x_high"]
    plane = Plane(origin=(0, hy, 0), x_dir=(1, 0, 0), z_dir=(0, -1, 0))
    outline = Polyline((-low, -hz), (low, -hz), (high, hz), (-high, hz), close=True)
    shape = extrude(plane * make_face(outline), amount=2 * hy)
    shape -= Box(2 * d["slot_half_x"], 2 * d["slot_half_y"], 2 * hz + 2)
    return shape, {"slot": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
