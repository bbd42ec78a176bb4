from build123d import Align, Axis, Box, Cylinder, Pos, Rot, chamfer, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def body(body_d, journal_d, ring_z, ring_high, gap, body_top, post_d, cap_high, foot_d=60, foot=8):
    """A column with a journal for the spout's ring and a post for the cap; a collar between them."""
    column = Cylinder(foot_d / 2, foot, align=UP)
    column = chamfer(column.edges().group_by(Axis.Z)[-1], 2) + Cylinder(body_d / 2, ring_z - gap, align=UP)
    column += Cylinder(journal_d / 2, body_top - 1, align=UP)
    collar = ring_z + ring_high + gap
    column += Pos(0, 0, collar) * Cylinder(body_d / 2, body_top - collar, align=UP)
    return column + Pos(0, 0, body_top - 1) * Cylinder(post_d / 2, 11, align=UP)


def spout(reach, body_d, journal_d, ring_z, ring_high, play, stem_d, head_z, tube_d=30, end_d=36, above=44):
    """Ring from z = 0 and a straight tube to the end, which holds the spray's stem."""
    middle = ring_high / 2
    shape = Cylinder(body_d / 2, ring_high, align=UP)
    shape += Pos(0, 0, middle) * Rot(Y=90) * Cylinder(tube_d / 2, reach, align=UP)
    low = head_z - ring_z
    end = Pos(reach, 0, low) * Cylinder(end_d / 2, above, align=UP)
    shape += fillet(end.edges().group_by(Axis.Z)[-1], 6)
    shape -= Cylinder(journal_d / 2 + play, 4 * ring_high)
    return shape - Pos(reach, 0, low - 1) * Cylinder(stem_d / 2 + play, above - 7, align=UP)


def spray(stem_d, head_d=36, high=90, stem=34):
    """Head below z = 0, stem above."""
    head = Cylinder(head_d / 2, high, align=DOWN)
    head = fillet(head.edges().group_by(Axis.Z)[0], 4)
    return head + Pos(0, 0, -1) * Cylinder(stem_d / 2, stem + 1, align=UP)


def cap(cap_z, cap_d, cap_high, post_d, play, lever_z, lever_pin, slot):
    """A cap over the post; a slot towards +x holds the lever on a pin across."""
    shape = Cylinder(cap_d / 2, cap_high, align=UP)
    shape = fillet(shape.edges().group_by(Axis.Z)[-1], 5)
    shape -= Cylinder(post_d / 2 + play, 11, align=UP)
    at = lever_z - cap_z
    shape -= Pos(-9, 0, at - 9) * Box(cap_d, slot, cap_high, align=(Align.MIN, Align.CENTER, Align.MIN))
    return shape + Pos(0, 0, at) * Rot(X=90) * Cylinder(lever_pin / 2, slot + 4)


def lever(lever_pin, play, slot, long=120, thick=10):
    """Eye about y and a blade along +x."""
    wide = slot - 2
    shape = Rot(X=90) * Cylinder(8, wide) + Pos(long / 2, 0, 0) * Box(long, wide, thick)
    shape += Pos(long, 0, 0) * Cylinder(wide / 2, thick)
    return shape - Rot(X=90) * Cylinder(lever_pin / 2 + play, 4 * wide)
