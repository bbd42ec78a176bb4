"""A link plate with a long hole in which a pin slides

Shows: SlotCenterToCenter, SlotOverall, extrude
Dimensions: {"length": 80, "width": 16, "thickness": 4, "travel": 30, "pin": 3}
"""

from build123d import SlotCenterToCenter, SlotOverall, extrude


def build(part):
    d = part.dimensions
    outline = SlotOverall(d["length"], d["width"]) - SlotCenterToCenter(d["travel"], 2 * d["pin"])
    shape = extrude(outline, amount=d["thickness"])
    return shape, {"mount": {"o": (-d["travel"] / 2, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
