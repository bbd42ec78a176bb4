from build123d import Circle, Pos, Rot, SlotCenterToCenter, extrude


def lower(toggle, link, thick, pin_d, play):
    hole = Circle(pin_d / 2 + play)
    flat = Pos(toggle / 2, 0) * SlotCenterToCenter(toggle, link) - hole - Pos(toggle, 0) * hole
    return Rot(X=90) * extrude(flat, thick)
