from build123d import Align, Box, Cylinder

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length, width, thickness, bore, recess = d["length"], d["width"], d["thickness"], d["bore"], d["recess"]
    recess_depth = d["recess_depth"]
    shape = Box(length, width, thickness, align=LOW) - Cylinder(bore / 2, 4 * thickness)
    shape -= Cylinder(recess / 2, recess_depth, align=LOW)
    return shape, {
        "body": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "stem": {"o": (0, 0, thickness), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
