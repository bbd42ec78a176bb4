from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length, width, thickness, block, inside = d["length"], d["width"], d["thickness"], d["block"], d["inside"]
    block_height, rail, rail_pitch, axis_z, screw_hole = d["block_height"], d["rail"], d["rail_pitch"], d["axis_z"], d["screw_hole"]
    shape = Box(length, width, thickness, align=LOW)
    for side in (-1, 1):
        shape += Pos(side * (inside + block) / 2, 0, 0) * Box(block, width, block_height, align=LOW)
        shape += Pos(0, side * rail_pitch / 2, axis_z) * Rot(Y=90) * Cylinder(rail / 2, inside + block)
    shape -= Pos(0, 0, axis_z) * Rot(Y=90) * Cylinder(screw_hole / 2, 2 * length)
    return shape, {
        "carriage": {"o": (-inside/2 + 10, 0, axis_z), "z": (1, 0, 0), "x": (0, 1, 0)},
        "screw": {"o": (inside/2 + block, 0, axis_z), "z": (1, 0, 0), "x": (0, 1, 0)},
    }
