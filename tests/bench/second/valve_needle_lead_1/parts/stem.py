from math import radians, tan

from build123d import Align, Cone, Cylinder, Pos

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def stem(port_d, stem_d, cone_deg, stem_top, knob_high, journal_d):
    """A rod with a conical point at the origin and a journal for the knob."""
    slope = tan(radians(cone_deg))
    point, shoulder = stem_d / 2 / slope, stem_top + port_d / 2 / slope
    rod = Cone(0, stem_d / 2, point, align=UP) + Pos(0, 0, point) * Cylinder(stem_d / 2, shoulder - point, align=UP)
    return rod + Pos(0, 0, shoulder) * Cylinder(journal_d / 2, knob_high - 2, align=UP)
