from build123d import Circle, Pos, SlotCenterToCenter, extrude


def build(part):
    d = part.dimensions
    length = d["length"]
    outline = Pos(length / 2, 0) * SlotCenterToCenter(length, d["width"])
    outline -= Pos(length / 2, 0) * SlotCenterToCenter(length - 2.5 * d["width"], d["slot_width"])
    for x in (0, length):
        outline -= Pos(x, 0) * Circle(d["bore_radius"])
    link = Pos(0, 0, d["play"] / 2) * extrude(outline, d["thickness"])
    return link, {
        "crank_pin": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "rocker_pin": {"o": (length, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
