from build123d import Align, Circle, Cylinder, Pos, SlotCenterToCenter, extrude

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
UP = {"z": (0, 0, 1), "x": (1, 0, 0)}


def build(part):
    d = part.dimensions
    length, low, level = d["length"], d["play"] / 2, d["thickness"] + d["play"]
    head = 4 * level + low  # shoulder above plane 4
    outline = Pos(length / 2, 0) * SlotCenterToCenter(length, d["width"]) - Circle(d["bore_radius"])
    bar = Pos(0, 0, low) * extrude(outline, d["thickness"])
    bar += Pos(length, 0, low) * Cylinder(d["pin_radius"], head - low, align=LOW)
    bar += Pos(length, 0, low) * Cylinder(d["spigot_radius"], head - low + d["spigot_length"], align=LOW)
    return bar, {
        "pivot": {"o": (0, 0, 0), **UP},
        "knee": {"o": (length, 0, level), **UP},
        "knee_k": {"o": (length, 0, 3 * level), **UP},
        "cap": {"o": (length, 0, head), "z": (0, 0, 1)},
    }
