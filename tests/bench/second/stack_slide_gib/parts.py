"""Everything lies along y; the bed's frame is that of the bar's underside."""

from build123d import Align, Box, Pos

UP = (Align.CENTER, Align.CENTER, Align.MIN)
RIGHT = (Align.MIN, Align.CENTER, Align.MIN)


def bed(left, channel, strips, length, wall, base):
    body = Pos(left - wall, 0, -base) * Box(channel + 2 * wall, length, base + strips, align=RIGHT)
    return body - Pos(X=left) * Box(channel, 2 * length, 2 * strips, align=RIGHT)


def bar(bar, bar_high, long):
    return Box(bar, long, bar_high, align=UP)


def gib(gib, high, long):
    return Box(gib, long, high, align=UP)


def strip(wide, length):
    return Box(wide, length, 6, align=RIGHT)


def keeper(gib, base):
    """A small plate before the gib's end, beside the bar."""
    return Pos(X=0.6 - gib, Z=-base / 2) * Box(gib + 12, 6, base / 2 + 12, align=RIGHT)
