"""The plank hangs down from its top face, a trestle stands on the ground with its outer face at x = 0."""

from build123d import Align, Axis, Box, Cylinder, Pos, Rot, chamfer, fillet


def plank(long, wide, plank):
    board = Box(long, wide, plank, align=(Align.CENTER, Align.CENTER, Align.MAX))
    board = fillet(board.edges().filter_by(Axis.Z), 12)
    return chamfer(board.edges().group_by(Axis.Z)[-1], 2)


def trestle(wide, board, under, notch):
    """A board with an arch below, so that it stands on two feet."""
    body = Box(board, wide, under, align=(Align.MIN, Align.CENTER, Align.MIN))
    return body - Rot(0, 90, 0) * Cylinder(notch / 2, 4 * board)


def cleat(cleat, across):
    body = Box(cleat, across, cleat, align=(Align.MIN, Align.CENTER, Align.MAX))
    return chamfer(body.edges().filter_by(Axis.Y).group_by(Axis.X)[-1].sort_by(Axis.Z)[0], 6)


def rail(span, rail, deep):
    body = Box(span, rail, deep, align=(Align.CENTER, Align.CENTER, Align.MIN))
    return chamfer(body.edges().filter_by(Axis.X), 1)
