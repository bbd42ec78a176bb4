from build123d import Align, Circle, Cylinder, Pos, Rot, SlotCenterToCenter, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def upper(toggle, link, thick, layer, pin_d, play):
    """Bored at the origin; its knee pin carries two more links in front of it."""
    flat = Pos(toggle / 2, 0) * SlotCenterToCenter(toggle, link) - Circle(pin_d / 2 + play)
    bar = Rot(X=90) * extrude(flat, thick)
    return bar + Pos(toggle, -thick / 2, 0) * Rot(X=90) * Cylinder(pin_d / 2, 2 * layer + thick / 2, align=UP)
