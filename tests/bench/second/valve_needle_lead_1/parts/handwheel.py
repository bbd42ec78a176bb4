from build123d import Align, Axis, Cylinder, chamfer

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def handwheel(knob_high, journal_d, across=28):
    knob = Cylinder(across / 2, knob_high, align=UP)
    knob = chamfer(knob.edges().sort_by(Axis.Z)[-1], 1.5)
    return knob - Cylinder(journal_d / 2, knob_high - 2, align=UP)
