from build123d import Align, Circle, Cylinder, Pos, Rot, SlotCenterPoint, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def knuckle(arm_x, arm_y, link, pin_d, play, axle, tyre_wide, wide=18):
    """Bored at the origin for the king pin; the arm goes back, the stub axle to the left."""
    flat = SlotCenterPoint((arm_x / 2, arm_y / 2), (arm_x, arm_y), wide)
    body = extrude(flat, link)
    stub = axle + tyre_wide / 2
    body += Pos(-stub, 0, link / 2) * Rot(Y=90) * Cylinder(link / 2, stub, align=UP)
    hole = Circle(pin_d / 2 + play)
    return body - extrude(hole + Pos(arm_x, arm_y) * hole, link)
