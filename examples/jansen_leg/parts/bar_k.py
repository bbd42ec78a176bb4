from build123d import Circle, Pos, SlotCenterToCenter, extrude

UP = {"z": (0, 0, 1), "x": (1, 0, 0)}


def build(part):
    d = part.dimensions
    length = d["length"]
    outline = Pos(length / 2, 0) * SlotCenterToCenter(length, d["width"])
    outline -= [Pos(x, 0) * Circle(d["bore_radius"]) for x in (0, length)]
    bar = Pos(0, 0, d["play"] / 2) * extrude(outline, d["thickness"])
    return bar, {"crank": {"o": (0, 0, 0), **UP}, "knee": {"o": (length, 0, 0), **UP}}
