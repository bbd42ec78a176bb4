"""Bars along x, posts along z; the bores of pins are added by the joints."""

from build123d import Align, Box, Pos

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def foot(foot, post):
    return Box(460, 380, foot, align=UP) - Pos(Z=15) * Box(post, post, foot, align=UP)


def post(post, high):
    return Pos(Z=15) * Box(post, post, high - 15, align=UP)


def arm(bar, thick, back, front):
    """A bar before the post's face, from behind its pin to the picket's."""
    return Pos(X=-back) * Box(back + front, thick, bar, align=(Align.MIN, Align.MAX, Align.CENTER))


def picket(thick, wide, high):
    return Box(wide, thick, high, align=(Align.CENTER, Align.MIN, Align.MAX))


def weight(bar, thick, long, wide, high):
    return Box(long, wide, high) - Box(long, thick, bar)
