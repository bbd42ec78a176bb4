from build123d import Align, Cylinder, Pos, Rot

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def latch_bolt(latch_d, gate_thick, bar=12, head=4):
    """Pressed into the gate, its axis along y; the latch turns before y = 0, between the gate and the head."""
    shank = Pos(0, 0, -gate_thick / 2) * Cylinder(latch_d / 2, gate_thick / 2 + bar + 2, align=UP)
    return Rot(X=90) * (shank + Pos(0, 0, bar + 1.5) * Cylinder(latch_d / 2 + 5, head, align=UP))
