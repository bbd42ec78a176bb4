from build123d import Align, Cylinder, Pos

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def pintle(hinge_d, lug, collar=4, tall=40):
    """Stands in the lower lug; the gate rests on its collar, whose lower face is z = 0."""
    pin = Pos(0, 0, -lug) * Cylinder(hinge_d / 2, lug + collar + tall, align=UP)
    return pin + Cylinder(hinge_d / 2 + 5, collar, align=UP)
