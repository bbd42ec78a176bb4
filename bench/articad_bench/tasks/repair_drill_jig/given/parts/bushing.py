from build123d import Align, Cylinder

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    outside, length, collar, collar_height, bore = d["outside"], d["length"], d["collar"], d["collar_height"], d["bore"]
    shape = Cylinder(outside / 2, length, align=HIGH) + Cylinder(collar / 2, collar_height, align=LOW) - Cylinder(bore / 2, 6 * length)
    return shape, {"plate": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
