from build123d import Align, Axis, Box, Cylinder, Pos, fillet


def guide_1(bolt_y, bolt_d, guide_high, play, wide=44, wall=7):
    """A block on the gate's front, bored for the bolt."""
    deep = bolt_d / 2 + wall - bolt_y
    block = Box(wide, deep, guide_high, align=(Align.CENTER, Align.MAX, Align.CENTER))
    block = fillet(block.edges().filter_by(Axis.Z).group_by(Axis.Y)[0], 8)
    return block - Pos(0, bolt_y, 0) * Cylinder(bolt_d / 2 + play, 2 * guide_high)
