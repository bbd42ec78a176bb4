from build123d import Align, Box, Cylinder, GridLocations, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    length, width, flange, outside, bore = d["length"], d["width"], d["flange"], d["outside"], d["bore"]
    bolt, bolt_pitch = d["bolt"], d["bolt_pitch"]
    shape = Box(length, width, flange, align=LOW) + Rot(X=90) * Cylinder(outside / 2, width)
    shape -= Rot(X=90) * Cylinder(bore / 2, 2 * width) + Box(2 * length, 2 * width, outside, align=HIGH)
    shape -= GridLocations(bolt_pitch, 0, 2, 1) * Cylinder(bolt / 2, 4 * flange)
    return shape, {
        "base": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "bolt_1": {"o": (bolt_pitch/2, 0, flange), "z": (0, 0, 1), "x": (1, 0, 0)},
        "bolt_2": {"o": (-bolt_pitch/2, 0, flange), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
