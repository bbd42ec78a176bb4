from build123d import Align, Circle, Cylinder, Pos, Rectangle, Rot, extrude


def latch(latch_d, bar_high, play, bar=12, reach=155, knob=60):
    """A bar along x, round about its pivot, with a knob to lift it by."""
    end = Circle(bar_high / 2) + Pos(reach / 2, 0) * Rectangle(reach, bar_high) - Circle(latch_d / 2 + play)
    flat = Pos(0, 0, 1) * extrude(end, bar)
    flat += Pos(knob, 0, bar) * Cylinder(7, 25, align=(Align.CENTER, Align.CENTER, Align.MIN))
    return Rot(X=90) * flat
