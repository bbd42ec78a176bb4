"""All upright parts about the column's middle; the crank about its shaft, along x."""

from build123d import Align, Box, Cylinder, Pos, Rot

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def along_x(radius, low, high):
    return Pos(X=(low + high) / 2) * Rot(0, 90, 0) * Cylinder(radius, high - low)


def foot(foot, guide):
    return Box(500, 420, foot, align=UP) - Pos(Z=foot - 25) * Box(guide, guide, foot, align=UP)


def guide(guide, bottom, guide_top, hole, axis_z, boss):
    body = Pos(Z=bottom) * Box(guide, guide, guide_top - bottom, align=UP)
    body += Pos(X=boss / 2, Z=axis_z) * Box(boss, 60, 60)
    return body - Box(hole, hole, 3 * guide_top)


def column(column, bottom, high):
    return Pos(Z=bottom) * Box(column, column, high - bottom, align=UP)


def cleat(cleat, column):
    return Box(200, 200, cleat, align=UP) - Box(column, column, 30)


def top(long, wide, top):
    return Box(long, wide, top, align=UP)


def crank(throw, thick, hole):
    body = along_x(20, 0, thick) + Pos(thick / 2, throw / 2) * Box(thick, throw, 28) + Pos(Y=throw) * along_x(14, 0, thick)
    return body - Pos(Y=throw) * along_x(hole / 2, -1, thick + 1)


def grip(long, spigot, thick):
    return along_x(14, 0, long) + along_x(spigot / 2, -thick, 0)
