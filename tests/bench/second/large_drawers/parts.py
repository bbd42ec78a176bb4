"""Boards and drawers of the chest; every part's frame has y = 0 at its front, but for front, knob and screw (see there)."""

from build123d import Align, Box, Cylinder, Pos, Rot

FRONT = (Align.CENTER, Align.MIN, Align.MIN)
AHEAD = (Align.CENTER, Align.MAX, Align.CENTER)


def along_y(diameter, start, end):
    return Pos(0, (start + end) / 2, 0) * Rot(90, 0, 0) * Cylinder(diameter / 2, end - start)


def bottom(wide, deep, board):
    return Box(wide, deep, board, align=FRONT)


top = bottom


def wall(board, deep, high):
    return Box(board, deep, high - 2 * board, align=FRONT)


def back(wide, back_thick, high):
    return Box(wide, back_thick, high, align=FRONT)


def shelf(cell_wide, deep, board):
    return Box(cell_wide, deep, board, align=FRONT)


def box(box_wide, box_deep, box_high, back_low, wall, base, cell_high, screw_d, screw_apart):
    body = Box(box_wide, box_deep, box_high, align=FRONT)
    body -= Pos(0, wall, base) * Box(box_wide - 2 * wall, box_deep - 2 * wall, box_high, align=FRONT)
    body -= Pos(0, box_deep - wall, box_high - back_low) * Box(box_wide - 2 * wall, 2 * wall, box_high, align=FRONT)
    for side in (-1, 1):
        body -= Pos(side * screw_apart / 2, 0, cell_high / 2) * along_y(screw_d, -1, wall + 1)
    return body


def front(front_wide, front_high, front_thick, knob_stem, knob_in, screw_d, screw_apart, screw_long, head_thick, wall):
    """Its back lies in y = 0."""
    body = Box(front_wide, front_thick, front_high, align=AHEAD)
    body -= along_y(knob_stem, -front_thick - 1, knob_in - front_thick)
    for side in (-1, 1):
        body -= Pos(side * screw_apart / 2, 0, 0) * along_y(screw_d, wall + head_thick - screw_long, 1)
    return body


def knob(knob_d, knob_stem, knob_in, knob_long, disc=12):
    """Turned knob; its stem enters the front at y = 0."""
    reach = knob_long - knob_in
    return along_y(knob_stem, 1 - reach, knob_in) + along_y(knob_d, -reach, disc - reach)


def screw(screw_d, screw_head, screw_long, head_thick):
    """Its head lies on y = 0, on the inside of the box."""
    return along_y(screw_d, head_thick - screw_long, 1) + along_y(screw_head, 0, head_thick)
