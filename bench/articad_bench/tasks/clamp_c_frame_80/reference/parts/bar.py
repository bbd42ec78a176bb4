from build123d import Cylinder, Pos


def build(part):
    d = part.dimensions
    diameter, length, knob, knob_length = d["diameter"], d["length"], d["knob"], d["knob_length"]
    shape = Cylinder(diameter / 2, length)
    shape += [Pos(0, 0, side * (length - knob_length) / 2) * Cylinder(knob / 2, knob_length) for side in (-1, 1)]
    return shape, {"screw": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
