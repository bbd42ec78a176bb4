from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    width, height, depth, wall, knob_diameter, knob = d["width"], d["height"], d["depth"], d["wall"], d["knob_diameter"], d["knob"]
    shape = Box(width, depth, height, align=(Align.CENTER, Align.MIN, Align.MIN))
    shape -= Pos(0, wall, wall) * Box(width - 2 * wall, depth - 2 * wall, height, align=(Align.CENTER, Align.MIN, Align.MIN))
    shape += Pos(0, 0, height / 2) * Rot(X=90) * (Cylinder(knob_diameter / 4, knob, align=LOW) + Pos(0, 0, knob / 2) * Cylinder(knob_diameter / 2, knob / 2, align=LOW))
    return shape, {
        "slide": {"o": (0, 0, -1), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
