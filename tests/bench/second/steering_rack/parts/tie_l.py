from build123d import Align, Circle, Cylinder, Pos, SlotCenterToCenter, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def tie(tie, link, gap, pin_d, play, wide=18):
    """Towards -x: bored at the origin for the rack's pin, with a pin for the knuckle at the other end."""
    flat = Pos(-tie / 2, 0) * SlotCenterToCenter(tie, wide) - Circle(pin_d / 2 + play)
    return extrude(flat, link) + Pos(-tie, 0, link / 2) * Cylinder(pin_d / 2, link + link / 2 + gap, align=UP)
