from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def pin(pin, long, head, head_wide=10):
    return Cylinder(pin / 2, long, align=LOW) + Pos(Z=long) * Cylinder(head_wide / 2, head, align=LOW)
