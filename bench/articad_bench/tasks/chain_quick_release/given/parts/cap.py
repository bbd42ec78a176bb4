from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    diameter, low, high, rod, slot = d["diameter"], d["low"], d["high"], d["rod"], d["slot"]
    slot_low, axis_z, stub = d["slot_low"], d["axis_z"], d["stub"]
    shape = Pos(0, 0, low) * Cylinder(diameter / 2, high - low, align=LOW) - Cylinder(rod / 2, 4 * high, align=HIGH)
    shape -= Pos(0, 0, slot_low) * Box(2 * diameter, slot, 2 * high, align=LOW)
    shape -= Pos(0, 0, axis_z) * Rot(X=90) * Cylinder(stub / 2, 2 * diameter)
    return shape, {"rod": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (0, 1, 0)}, "lever": {"o": (0, 0, axis_z), "z": (0, 1, 0), "x": (1, 0, 0)}}
