from build123d import Align, Box, Cylinder, GridLocations

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length, width, thickness, hole, pitch = d["length"], d["width"], d["thickness"], d["hole"], d["pitch"]
    dowel, dowel_pitch = d["dowel"], d["dowel_pitch"]
    shape = Box(length, width, thickness, align=LOW) - GridLocations(pitch, 0, 3, 1) * Cylinder(hole / 2, 4 * thickness)
    shape -= GridLocations(dowel_pitch, 0, 2, 1) * Cylinder(dowel / 2, 4 * thickness)
    return shape, {
        "first": {"o": (-pitch, 0, thickness), "z": (0, 0, 1), "x": (1, 0, 0)},
        "middle": {"o": (0, 0, thickness), "z": (0, 0, 1), "x": (1, 0, 0)},
        "last": {"o": (pitch, 0, thickness), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
