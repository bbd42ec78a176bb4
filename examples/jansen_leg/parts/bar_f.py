from build123d import Align, Cylinder, Pos, SlotCenterToCenter, extrude

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
UP = {"z": (0, 0, 1), "x": (1, 0, 0)}


def build(part):
    d = part.dimensions
    length, low, level = d["length"], d["play"] / 2, d["thickness"] + d["play"]
    head = 2 * level + low  # shoulder above plane 2
    bar = Pos(length / 2, 0, low) * extrude(SlotCenterToCenter(length, d["width"]), d["thickness"])
    for x in (0, length):
        bar += Pos(x, 0, low) * Cylinder(d["pin_radius"], head - low, align=LOW)
        bar += Pos(x, 0, low) * Cylinder(d["spigot_radius"], head - low + d["spigot_length"], align=LOW)
    return bar, {
        "hip": {"o": (0, 0, level), **UP},
        "ankle": {"o": (length, 0, level), **UP},
        "hip_cap": {"o": (0, 0, head), "z": (0, 0, 1)},
        "ankle_cap": {"o": (length, 0, head), "z": (0, 0, 1)},
    }
