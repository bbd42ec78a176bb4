from build123d import Cylinder, Torus


def build(part):
    d = part.dimensions
    outside, inside, width, pitch, groove = d["outside"], d["inside"], d["width"], d["pitch"], d["groove"]
    shape = Cylinder(outside / 2, width) - Cylinder(inside / 2, 4 * width) - Torus(pitch / 2, groove)
    return shape, {"inner": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}, "cage": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
