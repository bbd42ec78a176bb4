from build123d import Align, Cylinder, Pos


def top_pin(hinge_d, lug, head=6, reach=45):
    """Hangs in the upper lug by its head, whose lower face is z = 0."""
    pin = Cylinder(hinge_d / 2, lug + reach, align=(Align.CENTER, Align.CENTER, Align.MAX))
    return pin + Pos(0, 0, head / 2) * Cylinder(hinge_d / 2 + 5, head)
