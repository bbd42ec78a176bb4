from math import cos, radians

from build123d import Align, Box, Cylinder, Pos, Rot

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def board(long, high, thick, peg_d, pitch, lean_deg, peg_z, screw=5, screw_in=30):
    """From its front, y = 0, backwards along +y; the pegs' holes lean as they do."""
    body = Box(long, thick, high, align=(Align.CENTER, Align.MIN, Align.MIN))
    for n in range(-2, 3):
        body -= Pos(n * pitch, 0, peg_z) * Rot(X=90 - lean_deg) * Cylinder(peg_d / 2, 6 * thick)
    for x in (screw_in - long / 2, long / 2 - screw_in):
        body -= Pos(x, 0, high / 2) * Rot(X=90) * Cylinder(screw / 2, 4 * thick)
    return body


def peg(peg_d, thick, reach, lean_deg):
    """Along z; its inner end is cut level with the board's back, which leans in this frame."""
    tilt = radians(lean_deg)
    rod = Pos(0, 0, -2 * thick) * Cylinder(peg_d / 2, 2 * thick + reach / cos(tilt), align=UP)
    behind = Rot(X=lean_deg - 90) * Pos(0, thick, 0) * Box(8 * peg_d, 8 * peg_d, 8 * peg_d, align=(Align.CENTER, Align.MIN, Align.CENTER))
    return rod - behind
