from build123d import Align, Cylinder, Pos, SlotCenterToCenter, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    length, play, spigot = d["length"], d["play"], d["spigot_length"]
    foot = -d["bearing"] - 1.5 * play  # shoulder below the plate
    low = play / 2
    high = low + d["thickness"]
    head = high + d["thickness"] + 2 * play  # shoulder above the next link

    link = Pos(length / 2, 0, low) * extrude(SlotCenterToCenter(length, d["width"]), d["thickness"])
    link += Pos(0, 0, high) * Cylinder(d["shaft_radius"], high - foot, align=DOWN)
    link += Pos(0, 0, low) * Cylinder(d["spigot_radius"], low - foot + spigot, align=DOWN)
    link += Pos(length, 0, low) * Cylinder(d["pin_radius"], head - low, align=UP)
    link += Pos(length, 0, low) * Cylinder(d["spigot_radius"], head - low + spigot, align=UP)
    return link, {
        "shaft": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "pin": {"o": (length, 0, high + play / 2), "z": (0, 0, 1), "x": (1, 0, 0)},
        "shaft_end": {"o": (0, 0, foot), "z": (0, 0, -1)},
        "pin_end": {"o": (length, 0, head), "z": (0, 0, 1)},
    }
