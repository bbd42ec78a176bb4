from build123d import Align, Cylinder, Pos, SlotCenterToCenter, extrude

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
UP = {"z": (0, 0, 1), "x": (1, 0, 0)}


def build(part):
    d = part.dimensions
    length, play, spigot = d["length"], d["play"], d["spigot_length"]
    low, level = play / 2, d["thickness"] + play
    foot = -d["bearing"] - 1.5 * play  # shoulder behind the board
    head = 4 * level + play / 2  # shoulder above plane 4

    crank = Pos(length / 2, 0, low) * extrude(SlotCenterToCenter(length, d["width"]), d["thickness"])
    crank += Pos(0, 0, foot) * Cylinder(d["shaft_radius"], level - foot, align=LOW)
    crank += Pos(0, 0, foot - spigot) * Cylinder(d["shaft_spigot"], 2 * spigot, align=LOW)
    crank += Pos(length, 0, low) * Cylinder(d["boss_radius"], 2 * level - play, align=LOW)
    crank += Pos(length, 0, low) * Cylinder(d["pin_radius"], head - low, align=LOW)
    crank += Pos(length, 0, low) * Cylinder(d["spigot_radius"], head - low + spigot, align=LOW)
    return crank, {
        "shaft": {"o": (0, 0, 0), **UP},
        "pin_j": {"o": (length, 0, 2 * level), **UP},
        "pin_k": {"o": (length, 0, 3 * level), **UP},
        "knob": {"o": (0, 0, foot), "z": (0, 0, -1)},
        "cap": {"o": (length, 0, head), "z": (0, 0, 1)},
    }
