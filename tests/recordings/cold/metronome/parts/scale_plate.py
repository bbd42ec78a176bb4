from build123d import Align, Box, Plane, Polygon, Pos, extrude


def build(part):
    d = part.dimensions
    b, t, h, th = d["bottom_half"], d["top_half"], d["height"], d["thickness"]
    outline = Plane.XZ * Polygon((-b, 0), (b, 0), (t, h), (-t, h), align=None)
    shape = Pos(0, -th / 2, 0) * extrude(outline, amount=th / 2, both=True)
    start, end = d["line_start"], d["line_end"]
    for i in range(int(d["line_count"])):
        side = 1 if i % 2 == 0 else -1
        z = d["first_line_z"] + i * d["line_pitch"]
        shape = shape - Pos(side * (start + end) / 2, -th + d["line_depth"], z) * Box(
            end - start, d["line_depth"] + 1, d["line_width"],
            align=(Align.CENTER, Align.MAX, Align.CENTER))
    return shape, {"back": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)}}
