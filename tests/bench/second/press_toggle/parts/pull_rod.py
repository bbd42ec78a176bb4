from build123d import Align, Circle, Cylinder, Pos, Rot, SlotCenterToCenter, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def pull_rod(pull, link, thick, layer, pin_d, play):
    """Its pin for the lever stands at the origin, the bore for the knee is at the other end."""
    flat = Pos(pull / 2, 0) * SlotCenterToCenter(pull, link) - Pos(pull, 0) * Circle(pin_d / 2 + play)
    bar = Rot(X=90) * extrude(flat, thick)
    return bar + Pos(0, -thick / 2, 0) * Rot(X=90) * Cylinder(pin_d / 2, layer + thick / 2, align=UP)
