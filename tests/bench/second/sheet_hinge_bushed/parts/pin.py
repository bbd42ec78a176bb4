from build123d import Align, Cylinder, Pos, Rot

HIGH = (Align.CENTER, Align.CENTER, Align.MAX)
LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def pin(pin, high, tail, head_wide=16, head_high=4, cross=3, from_end=4):
    long = high + tail
    shaft = Cylinder(pin / 2, long, align=HIGH) + Cylinder(head_wide / 2, head_high, align=LOW)
    return shaft - Pos(Z=from_end - long) * Rot(X=90) * Cylinder(cross / 2, 2 * pin)
