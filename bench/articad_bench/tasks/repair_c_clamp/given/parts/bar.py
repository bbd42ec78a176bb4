from build123d import Align, Box, Cylinder, Pos


def build(part):
    d = part.dimensions
    diameter, length, knob, knob_length = d["diameter"], d["length"], d["knob"], d["knob_length"]
    flat = Pos(d["flat"], 0, 0) * Box(diameter, diameter, length, align=(Align.MIN, Align.CENTER, Align.CENTER))
    shape = Cylinder(diameter / 2, length) - flat
    shape += [Pos(0, 0, side * (length - knob_length) / 2) * Cylinder(knob / 2, knob_length) for side in (-1, 1)]
    return shape, {"screw": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
