from build123d import Align, Axis, Box, Cylinder, Pos, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)
BACK = (Align.CENTER, Align.MIN, Align.MIN)
FRONT = (Align.CENTER, Align.MAX, Align.MIN)


def case(wide, deep, high, board, foot, opening, bottom):
    """Box with a second floor over the drawer's opening, on feet that are cut out of its sides."""
    body = Box(wide, deep, high, align=BACK)
    inner = wide - 2 * board
    chest = foot + board + opening
    body -= Pos(0, board, chest + bottom) * Box(inner, deep - 2 * board, high, align=BACK)
    body -= Pos(0, -board, foot + board) * Box(inner, deep, opening, align=BACK)
    body -= Box(wide - 2 * foot, 3 * deep, 2 * foot) + Pos(0, deep / 2, 0) * Box(2 * wide, deep - 2 * foot, 2 * foot)
    return body - Pos(0, board, 0) * Box(inner, deep - 2 * board, foot, align=BACK)


def lid(lid_long, lid_deep, lid):
    return Box(lid_long, lid_deep, lid, align=FRONT)


def drawer(wide, deep, board, opening, air, side=15, thin=10):
    body = Box(wide - 2 * board - 2 * air, deep - board - 5, opening - air, align=BACK)
    return body - Pos(0, board, thin) * Box(wide - 2 * board - 2 * air - 2 * side, deep - 2 * board - 5 - side, opening, align=BACK)


def knob(knob, stem, proud, knob_head):
    head = Pos(0, 0, proud - knob_head) * Cylinder(knob / 2, knob_head, align=UP)
    return fillet(head.edges().sort_by(Axis.Z)[-1], 2) + Cylinder(stem / 2, proud - knob_head, align=UP)
