from build123d import Circle, Plane, Pos, SlotCenterToCenter, extrude


def build(part):
    d = part.dimensions
    length, half = d["length"], d["half"]
    outline = Pos(length / 2, 0) * SlotCenterToCenter(length, d["width"])
    outline -= [Pos(x, 0) * Circle(d["bore_radius"]) for x in (0, length)]
    axis = {"z": (0, -1, 0), "x": (1, 0, 0)}
    return extrude(Plane.XZ * outline, half, both=True), {"handle": {"o": (0, 0, 0), **axis}, "arm": {"o": (length, 0, 0), **axis}}
