from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    width, eye, bore, length, thickness = d["width"], d["eye"], d["bore"], d["length"], d["thickness"]
    bow_z, bow_pin, bow_pin_length = d["bow_z"], d["bow_pin"], d["bow_pin_length"]
    shape = Rot(X=90) * Cylinder(eye / 2, width) + Box(thickness, width, length, align=LOW)
    shape += Pos(0, 0, bow_z) * Rot(X=90) * Cylinder(bow_pin / 2, bow_pin_length)
    shape -= Rot(X=90) * Cylinder(bore / 2, 2 * width)
    return shape, {"base": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)}, "bow": {"o": (0, 0, bow_z), "z": (0, 1, 0), "x": (1, 0, 0)}}
