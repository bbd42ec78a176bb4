from build123d import Cylinder, Torus


def build(part):
    d = part.dimensions
    outside, bore, width, pitch, groove = d["outside"], d["bore"], d["width"], d["pitch"], d["groove"]
    shape = Cylinder(outside / 2, width) - Cylinder(bore / 2, 4 * width) - Torus(pitch / 2, groove)
    return shape, {"outer": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
