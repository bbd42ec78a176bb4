"""Links lie along x in XZ, their back face at y = 0; pins point to the front."""

from build123d import Align, Axis, Box, Circle, Cylinder, Pos, Rot, extrude, fillet, make_hull

UP = (Align.CENTER, Align.CENTER, Align.MIN)
FLAT = Rot(90, 0, 0)


def stud(x, z, radius, back, front):
    return Pos(x, back, z) * FLAT * Cylinder(radius, back - front, align=UP)


def stand(crank_x, span, axis_z, link_y, thick, pin_d, air, wide=190, deep=110, tall=130, foot=16, board=12):
    body = Pos(0, board / 2 - 4, 0) * Box(wide, deep, foot, align=UP)
    body = fillet(body.edges().filter_by(Axis.Z), 12)
    upright = Pos(0, board / 2, 0) * Box(wide - 30, board, tall, align=UP)
    body += fillet(upright.edges().filter_by(Axis.Y).group_by(Axis.Z)[-1], 20)
    for x in (crank_x, crank_x + span):
        body += stud(x, axis_z, 7, 1, link_y + air) + stud(x, axis_z, pin_d / 2, 1, link_y - thick)
    return body


def arm(length, thick, air, end_r, pin_d, play):
    flat = make_hull((Circle(end_r) + Pos(length, 0) * Circle(end_r - 1)).edges()) - Circle(pin_d / 2 + play)
    return FLAT * extrude(flat, thick) + stud(length, 0, pin_d / 2, -1, -2 * thick - air)


def crank(crank_long, thick, air, end_r, pin_d, play):
    return arm(crank_long, thick, air, end_r, pin_d, play)


def rocker(rocker_long, thick, air, end_r, pin_d, play):
    return arm(rocker_long, thick, air, end_r, pin_d, play)


def coupler(coupler_long, third_along, third_up, thick, end_r, pin_d, play):
    """A three-cornered plate; a pin stands at its third point."""
    flat = make_hull((Circle(end_r) + Pos(coupler_long, 0) * Circle(end_r) + Pos(third_along, third_up) * Circle(end_r - 2)).edges())
    flat -= Pos(35, 16) * Circle(8)
    for x in (0, coupler_long):
        flat -= Pos(x, 0) * Circle(pin_d / 2 + play)
    return FLAT * extrude(flat, thick) + stud(third_along, third_up, 3, -1, -thick - 9)
