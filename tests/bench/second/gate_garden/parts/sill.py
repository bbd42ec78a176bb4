from build123d import Align, Box, Cylinder, Pos


def sill(span, bolt_x, bolt_y, bolt_d, before=60, behind=160, deep=150, hole=120):
    slab = Pos(0, -before, 0) * Box(span, before + behind, deep, align=(Align.MIN, Align.MIN, Align.MAX))
    return slab - Pos(bolt_x, bolt_y, 0) * Cylinder(bolt_d / 2 + 2, hole, align=(Align.CENTER, Align.CENTER, Align.MAX))
