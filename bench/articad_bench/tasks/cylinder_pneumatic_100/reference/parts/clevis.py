from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    side, length, slot, slot_depth, hole = d["side"], d["length"], d["slot"], d["slot_depth"], d["hole"]
    hole_z = d["hole_z"]
    shape = Box(side, side, length, align=LOW) - Pos(0, 0, length) * Box(slot, 2 * side, 2 * slot_depth)
    shape -= Pos(0, 0, hole_z) * Rot(Y=90) * Cylinder(hole / 2, 2 * side)
    return shape, {"rod": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
