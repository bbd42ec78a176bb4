from build123d import Align, Box, Cylinder, GridLocations, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    length, width, foot, axis_z, block_length = d["length"], d["width"], d["foot"], d["axis_z"], d["block_length"]
    bore, foot_hole, foot_pitch, bolt, bolt_pitch = d["bore"], d["foot_hole"], d["foot_pitch"], d["bolt"], d["bolt_pitch"]
    bolt_depth = d["bolt_depth"]
    shape = Box(length, width, foot, align=LOW) + Box(block_length, width, axis_z, align=LOW)
    shape -= Pos(0, 0, axis_z) * Rot(X=90) * Cylinder(bore / 2, 2 * width)
    shape -= GridLocations(foot_pitch, 0, 2, 1) * Cylinder(foot_hole / 2, 4 * foot)
    shape -= Pos(0, 0, axis_z) * GridLocations(bolt_pitch, 0, 2, 1) * Cylinder(bolt / 2, bolt_depth, align=HIGH)
    return shape, {
        "shaft": {"o": (0, 0, axis_z), "z": (0, 1, 0), "x": (1, 0, 0)},
        "cap": {"o": (0, 0, axis_z), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
