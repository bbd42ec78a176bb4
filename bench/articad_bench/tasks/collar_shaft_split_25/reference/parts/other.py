from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    outside, width, bore, slit, screw = d["outside"], d["width"], d["bore"], d["slit"], d["screw"]
    pitch, depth = d["pitch"], d["depth"]
    shape = Cylinder(outside / 2, width) - Cylinder(bore / 2, 4 * width) - Pos(0, -slit / 2, 0) * Box(4 * outside, 4 * outside, 4 * width, align=(Align.CENTER, Align.MIN, Align.CENTER))
    shape -= [Pos(x, 0, 0) * Rot(X=90) * Cylinder(screw / 2, depth, align=LOW) for x in (-pitch / 2, pitch / 2)]
    return shape, {"shaft": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
