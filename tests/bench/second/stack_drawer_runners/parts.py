"""Boards from their lower front left corner, or from the middle of the lower front edge."""

from build123d import Align, Box, Pos

LOW = (Align.MIN, Align.MIN, Align.MIN)
MIDDLE = (Align.CENTER, Align.MIN, Align.MIN)


def carcass_bottom(wide, deep, board):
    return Box(wide, deep, board, align=MIDDLE)


def side(board, deep, high):
    return Box(board, deep, high, align=LOW)


def runner(runner, long, band, groove):
    body = Box(runner, long, band, align=LOW)
    return body - Pos(runner - 8, 0, (band - groove) / 2) * Box(8, long, groove, align=LOW)


def rail(out, long, groove):
    return Pos(X=-out) * Box(out, long, groove - 0.5, align=LOW)


def drawer(drawer, thin, long, tall, panel):
    """A box that is open above."""
    inside = Box(drawer - 2 * thin, long - 2 * thin, tall, align=MIDDLE)
    return Box(drawer, long, tall, align=MIDDLE) - Pos(0, thin, panel) * inside
