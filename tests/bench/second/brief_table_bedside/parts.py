"""The column is a square tube of boards, the stem a solid post within it."""

from build123d import Align, Axis, Box, Cylinder, Pos, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def column(slim, broad, wall, play, floor_z, column_top):
    high = column_top - floor_z
    body = Box(slim + 2 * wall, broad + 2 * wall, high, align=UP)
    return body - Box(slim + 2 * play, broad + 2 * play, 3 * high, align=UP)


def stem(slim, broad, under, floor_z, clear=15):
    """Hangs below z = 0 into the column."""
    return Box(slim, broad, under - floor_z - clear, align=DOWN)


def top(long, deep, top, left, corner=25):
    board = Pos(long / 2 - left, 0, 0) * Box(long, deep, top, align=UP)
    return fillet(board.edges().filter_by(Axis.Z), corner)


def beam(slim, broad, wall, foot, foot_wide, half):
    """Lies across between the feet, below the column."""
    return Box(slim + 2 * wall, 2 * half - foot_wide, foot, align=UP)


def foot(foot, foot_wide, back_x, front_x, over=28):
    long = front_x - back_x + 2 * over
    rail = Pos((front_x + back_x) / 2, 0, 0) * Box(long, foot_wide, foot, align=UP)
    return fillet(rail.edges().filter_by(Axis.Z), 20)


def castor(castor, castor_d):
    return Cylinder(castor_d / 2, castor, align=DOWN)
