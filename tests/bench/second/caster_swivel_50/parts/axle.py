from build123d import Cylinder, Pos


def axle(axle_d, inner, leg, head_d=14, head=4):
    """About z, with a riveted head outside of each leg."""
    across = inner / 2 + leg
    pin = Cylinder(axle_d / 2, 2 * across)
    for side in (-1, 1):
        pin += Pos(0, 0, side * (across + head / 2)) * Cylinder(head_d / 2, head)
    return pin
