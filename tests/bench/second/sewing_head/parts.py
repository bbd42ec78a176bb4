from math import cos, radians, sin

from build123d import Align, Box, Circle, Cylinder, Pos, Rectangle, Rot, extrude, make_hull

TO_FRONT = Rot(90, 0, 0)  # z to -y
UP = (Align.CENTER, Align.CENTER, Align.MIN)


def layer(flat, gap, thick):
    """Extrude an outline of x and z from y = -gap to the front."""
    return Pos(0, -gap, 0) * TO_FRONT * extrude(flat, thick)


def pin_at(x, z, radius, near, far):
    return Pos(x, (near + far) / 2, z) * TO_FRONT * Cylinder(radius, abs(far - near))


def plate(left, under, ox, oz, p, pin, play, shaft, rail_wide, rail_deep, rail_y, rail_top, wide=150, high=225, thick=10, foot=15, deep=80):
    """Upright plate on a foot, with the swing link's pin and a rail for the needle bar on a bracket."""
    corner = (Align.MIN, Align.MIN, Align.MIN)
    body = Pos(left, 0, -under) * Box(wide, thick, high, align=corner) + Pos(left, -35, -under) * Box(wide, deep, foot, align=corner)
    body += pin_at(ox, oz, pin / 2, 1, -4 * p) + Pos(0, 1, -117) * Box(12, rail_deep / 2 - rail_y + 3, 11, align=(Align.CENTER, Align.MAX, Align.MIN))
    body += Pos(0, rail_y, -107) * Box(rail_wide, rail_deep, rail_top + 107, align=UP)
    return body - pin_at(0, 0, shaft / 2 + play, -1, 2 * thick)


def crank(throw, disc, gap, thick, p, pin, shaft):
    body = layer(Circle(disc), gap, thick) + pin_at(0, 0, shaft / 2, -gap - 1, 14)
    return body + pin_at(throw, 0, pin / 2, -gap - 1, -3 * p)


def strip(long, half):
    return Pos(long / 2, 0) * Rectangle(long, 2 * half) + Circle(half) + Pos(long, 0) * Circle(half)


def rod(rod, half, gap, thick, pin, play):
    return layer(strip(rod, half) - Circle(pin / 2 + play) - Pos(rod, 0) * Circle(pin / 2 + play), gap, thick)


def lever(arm, tip, bend_deg, half, gap, thick, pin, play):
    end = Pos(tip * cos(radians(bend_deg)), tip * sin(radians(bend_deg)))
    outline = make_hull((Circle(half) + Pos(arm, 0) * Circle(half) + end * Circle(half)).edges())
    return layer(outline - Circle(pin / 2 + play) - Pos(arm, 0) * Circle(pin / 2 + play), gap, thick)


def link(swing, half, gap, thick, pin, play, p):
    return layer(strip(swing, half) - Circle(pin / 2 + play), gap, thick) + pin_at(swing, 0, pin / 2, -gap - 1, p - gap)


def bar(gap, p, pin, play, rail_wide, rail_deep, rail_y, wide=24, high=26, deep=9.2, needle=4, reach=66):
    """A block on the rail with the wrist pin to the back and the needle beside the rail's bracket."""
    middle = -gap - deep / 2
    body = Pos(0, middle, 0) * Box(wide, deep, high) + pin_at(0, 0, pin / 2, -gap - 1, p - gap)
    body -= Pos(0, rail_y + 2 * p, 0) * Box(rail_wide + 2 * play, rail_deep + 2 * play, 2 * high)
    return body + Pos(10, middle, 0) * Cylinder(needle / 2, reach, align=(Align.CENTER, Align.CENTER, Align.MAX))
