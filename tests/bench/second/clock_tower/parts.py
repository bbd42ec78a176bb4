"""The dial on a foot, with a stepped arbor: each hand runs on its own diameter, before a shoulder."""

from build123d import Align, Axis, Box, Circle, Cylinder, Pos, Polygon, Rectangle, Rot, chamfer, extrude, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)
FLAT = Rot(90, 0, 0)


def rod(radius, back, front):
    return Pos(0, back, 0) * FLAT * Cylinder(radius, back - front, align=UP)


def dial(dial, arbor, hour_y, minute_y, second_y, thick, air, board=12):
    body = rod(dial / 2, board, 0)
    body = chamfer(body.edges().group_by(Axis.Y)[0], 1)
    foot = Pos(0, 4, -dial / 2 - 20) * Box(110, 60, 30, align=UP)
    body += fillet(foot.edges().filter_by(Axis.Z), 5)
    body += rod(arbor / 2 + 3, 1, hour_y + air / 2)
    body += rod(arbor / 2, 1, minute_y + air / 2)
    body += rod(arbor / 2 - 0.5, 1, second_y + air / 2)
    tip = rod(arbor / 2 - 1, 1, second_y - thick - 2)
    return body + chamfer(tip.edges().group_by(Axis.Y)[0], 0.5)


def hand(reach, tail, hub, thick, bore, wide):
    flat = Polygon((-wide / 2, 0), (wide / 2, 0), (1.5, reach), (-1.5, reach), align=None)
    flat += Pos(0, -tail / 2) * Rectangle(wide, tail) + Circle(hub / 2)
    return FLAT * extrude(flat - Circle(bore / 2), thick)


hour_hand = minute_hand = second_hand = hand
