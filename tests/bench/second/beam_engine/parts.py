"""Bars lie in XZ, their back face at y = 0; pins point along y."""

from math import cos, radians, sin

from build123d import Align, Axis, Box, Circle, Cylinder, Polygon, Pos, Rot, SlotCenterToCenter, chamfer, extrude, make_hull

UP = (Align.CENTER, Align.CENTER, Align.MIN)
FLAT = Rot(90, 0, 0)


def stud(x, z, radius, back, front):
    return Pos(x, back, z) * FLAT * Cylinder(radius, back - front, align=UP)


def frame(beam_z, crank_z, side, gov_x, gov_z, pin_d, wheel_y, wheel, beam_y, beam_thick, air, long=370, left=170, deep=110, tall=300, foot=14, board=12, low=165, rail_low=146, rail_high=255):
    """Foot and board with studs for beam, flywheel and governor, and a T rail for the crosshead."""
    x = long / 2 - left
    body = Pos(x, 5, 0) * Box(long, deep, foot, align=UP)
    body = chamfer(body.edges().filter_by(Axis.Z), 4)
    body += Pos(x, board / 2, 0) * Box(long, board, low, align=UP) + Pos(0, board / 2, 0) * Box(40, board, tall, align=UP)
    body += Pos(-left, board / 2, 0) * Box(left - side + 8, board, 255, align=(Align.MIN, Align.CENTER, Align.MIN))
    body += stud(0, beam_z, 11, 1, beam_y + air) + stud(0, beam_z, 5, 1, beam_y - beam_thick)
    for at_x, at_z in ((side, crank_z), (gov_x, gov_z)):
        body += stud(at_x, at_z, 8, 1, wheel_y + air) + stud(at_x, at_z, pin_d / 2, 1, wheel_y - wheel)
    high = rail_high - rail_low
    body += Pos(-side, 1, rail_low) * Box(6, 5, high, align=(Align.CENTER, Align.MAX, Align.MIN))
    return body + Pos(-side, -3, rail_low) * Box(14, 4, high, align=(Align.CENTER, Align.MAX, Align.MIN))


def beam(half, beam_thick, end_r, pin_d, thick, air, play, middle=18):
    """About its bearing; the right pin points back to the rod, the left one forward to the link."""
    outline = make_hull((Pos(-half, 0) * Circle(end_r) + Pos(half, 0) * Circle(end_r) + Circle(middle)).edges())
    body = FLAT * extrude(outline - Circle(5 + play), beam_thick)
    body += stud(half, 0, pin_d / 2, air + thick, -1)
    return body + stud(-half, 0, pin_d / 2, -1, -beam_thick - air - thick)


def bar(length, thick, end_r, pin_d, play):
    hole = Circle(pin_d / 2 + play)
    return FLAT * extrude(Pos(length / 2, 0) * SlotCenterToCenter(length, 2 * end_r) - hole - Pos(length, 0) * hole, thick)


def link(link_long, thick, end_r, pin_d, play):
    return bar(link_long, thick, end_r, pin_d, play)


def rod(rod_long, thick, end_r, pin_d, play):
    return bar(rod_long, thick, end_r, pin_d, play)


def crosshead(link_y, thick, pin_d, play, air, wide=24, high=24, front=-12):
    """A block about the rail, its pin at z = 0."""
    body = Pos(0, -0.6, 0) * Box(wide, -front - 0.6, high, align=(Align.CENTER, Align.MAX, Align.CENTER))
    body -= Box(6 + 2 * play, 8, 2 * high, align=(Align.CENTER, Align.MAX, Align.CENTER))
    body -= Pos(0, -3 + play, 0) * Box(14 + 2 * play, 4 + 2 * play, 2 * high, align=(Align.CENTER, Align.MAX, Align.CENTER))
    return body + stud(0, 0, 8, front + 1, link_y + air) + stud(0, 0, pin_d / 2, front + 1, link_y - thick)


def flywheel(throw, wheel_d, wheel, thick, air, pin_d, play, hole=24):
    """Its crank pin lies on x."""
    disc = Circle(wheel_d / 2) - Circle(pin_d / 2 + play)
    for turn in (90, 180, 270):
        disc -= Pos(44 * cos(radians(turn)), 44 * sin(radians(turn))) * Circle(hole / 2)
    body = FLAT * extrude(disc, wheel)
    return body + stud(throw, 0, pin_d / 2, -1, -wheel - air - thick)


def governor(gov_d, wheel, pin_d, play):
    disc = Circle(gov_d / 2) - Circle(pin_d / 2 + play)
    body = FLAT * extrude(disc, wheel)
    groove = FLAT * extrude(Circle(gov_d) - Circle(gov_d / 2 - 2), 4)
    return body - Pos(0, -4, 0) * groove
