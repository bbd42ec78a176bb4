from build123d import Box, Plane, Polygon, extrude


def build(part):
    d = part.dimensions
    b, t, h = d["bottom_half"], d["top_half"], d["height"]
    outline = Plane.XZ * Polygon((-b, -h / 2), (b, -h / 2), (t, h / 2), (-t, h / 2), align=None)
    block = extrude(outline, amount=d["thickness"] / 2, both=True)
    slot = Box(d["slot_width"], d["slot_thickness"], h + 2)
    return block - slot, {"slot": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
