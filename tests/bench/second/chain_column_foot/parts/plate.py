from build123d import Align, Box, Cylinder, GridLocations

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    side, thickness, hole, pitch = d["side"], d["thickness"], d["hole"], d["pitch"]
    shape = Box(side, side, thickness, align=LOW) - GridLocations(pitch, pitch, 2, 2) * Cylinder(hole / 2, 4 * thickness)
    return shape, {"column": {"o": (0, 0, thickness), "z": (0, 0, 1), "x": (1, 0, 0)}}
