"""Top, case and batten have z = 0 at the top's underside; the leaf's origin is on the hinge; frames of legs stand on the floor."""

from build123d import Align, Axis, Box, Cylinder, Pos, Rot, chamfer, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def along_y(radius, long, y=0):
    return Pos(0, y, 0) * Rot(90, 0, 0) * Cylinder(radius, long)


def top(long, wide, board):
    body = Box(long, wide, board, align=UP)
    return fillet(body.edges().filter_by(Axis.Z).group_by(Axis.X)[0], 10)


def leaf(leaf, wide, board, under, hinge_z):
    body = Pos(0, 0, under - hinge_z) * Box(leaf, wide, board, align=(Align.MIN, Align.CENTER, Align.MIN))
    return fillet(body.edges().filter_by(Axis.Z).group_by(Axis.X)[-1], 10)


def eye(side, drop, bore, eye):
    """A hinge's half: an eye about the pin and a foot along the board's underside."""
    body = along_y(drop - 0.5, eye) + Pos(side * 16, 0, 0.5) * Box(26, eye, 2 * drop - 1) + Pos(side * 5, 0, drop / 2) * Box(8, eye, drop)
    return body - along_y(bore, 900)


eye_top = eye_leaf = eye_top_front = eye_top_back = eye_leaf_front = eye_leaf_back = eye


def pin(long, pin):
    return chamfer(along_y(pin / 2, long).edges(), 0.5)


def case(batten, tall, air, case, long=440):
    body = Pos(20, 0, 0) * Box(long - 40, batten + 2 * air + 2 * case, tall + air + case, align=DOWN)
    return body - Box(2 * long, batten + 2 * air, tall + air, align=DOWN)


def batten(batten, tall, batten_long, air):
    body = Pos(0, 0, 0) * Box(batten_long, batten, tall, align=(Align.MIN, Align.CENTER, Align.MAX))
    return chamfer(body.edges().filter_by(Axis.X).group_by(Axis.Z)[0], 1)


def legs(under, leg, leg_x, apron, shelf_z, wheel, axle, wheel_x):
    """A side frame: two legs, that over the wheel shorter, with an apron and a rail below the shelf."""
    body = Pos(leg_x, 0, 0) * Box(leg, leg, under, align=UP) + Pos(-leg_x, 0, wheel - 18) * Box(leg, leg, under - wheel + 18, align=UP)
    body += Pos(0, 0, under) * Box(2 * leg_x, 22, apron, align=DOWN) + Pos(0, 0, shelf_z) * Box(2 * leg_x, 22, 50, align=DOWN)
    body = chamfer(body.edges().filter_by(Axis.Z).group_by(Axis.X)[-1], 2)
    return body - Pos(wheel_x, 0, wheel) * along_y(axle / 2, 4 * leg)


legs_front = legs_back = legs


def shelf(leg_x, leg_y, leg, shelf):
    return Box(2 * leg_x - leg, 2 * leg_y - leg, shelf, align=DOWN)


def axle(leg_y, leg, tread, axle):
    body = along_y(axle / 2, 2 * leg_y + leg + 2 * tread + 8)
    return chamfer(body.edges(), 1)


def wheel(wheel, tread, axle, play):
    return chamfer(along_y(wheel, tread).edges(), 1.5) - along_y(axle / 2 + play, 2 * tread)
