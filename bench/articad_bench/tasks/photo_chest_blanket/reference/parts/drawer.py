from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    width, height, depth, wall, front, knob_diameter = d["width"], d["height"], d["depth"], d["wall"], d["front"], d["knob_diameter"]
    knob, knob_pitch = d["knob"], d["knob_pitch"]
    shape = Box(width, depth, height, align=(Align.CENTER, Align.MIN, Align.MIN))
    shape -= Pos(0, front, wall) * Box(width - 2 * wall, depth - front - wall, height, align=(Align.CENTER, Align.MIN, Align.MIN))
    for x in (-knob_pitch / 2, knob_pitch / 2):
        shape += Pos(x, 0, height / 2) * Rot(X=90) * (Cylinder(knob_diameter / 4, knob, align=LOW) + Pos(0, 0, knob / 2) * Cylinder(knob_diameter / 2, knob / 2, align=LOW))
    return shape, {
        "slide": {"o": (0, 0, -2), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
