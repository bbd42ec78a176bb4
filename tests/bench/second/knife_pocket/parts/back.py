from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.MIN, Align.MIN, Align.MIN)


def back(long, high, handle, slot, pitch, pin_d, pin_x, pin_z, floor=5):
    """A comb of four walls on a floor, with two riveted pins across."""
    comb = Box(long, handle, high, align=LOW)
    for number in (-1, 0, 1):
        middle = handle / 2 + number * pitch
        comb -= Pos(-1, middle - slot / 2, floor) * Box(long + 2, slot, high, align=LOW)
    for x in (pin_x, long - pin_x):
        comb += Pos(x, handle / 2, pin_z) * Rot(X=90) * Cylinder(pin_d / 2, handle)
    return comb
