"""Slats lie along x in XZ, their back face at y = 0; pins of rising slats point to the front."""

from build123d import Align, Box, Circle, Cylinder, Pos, Rot, SlotCenterToCenter, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = (Align.CENTER, Align.MAX, Align.MIN)
FLAT = Rot(90, 0, 0)


def stud(x, z, radius, back, front):
    return Pos(x, back, z) * FLAT * Cylinder(radius, back - front, align=UP)


def board(px, pz, thick, air, pin_d, slide_y, bar_wide, bar, skin, long=46, board=10, tall=250, lug_low=225, lug=12, bar_low=64):
    """A wall board with a stud for the first slat; a flat bar hangs before it from a lug."""
    body = Box(long, board, tall, align=(Align.MIN, Align.MIN, Align.MIN))
    body += stud(px, pz, pin_d / 2, 1, -air - thick)
    body += Pos(px, 1, lug_low) * Box(14, thick - slide_y + 1, lug, align=FRONT)
    return body + Pos(px, slide_y - skin, bar_low) * Box(bar_wide, bar, lug_low - bar_low + 1, align=FRONT)


def slide(thick, air, pin_d, play, bar_wide, bar, skin, wide=22, tall=24):
    """A block about the bar, its pin pointing back."""
    body = Pos(0, 0, -tall / 2) * Box(wide, thick, tall, align=FRONT)
    body -= Pos(0, -skin + play, -tall) * Box(bar_wide + 2 * play, bar + 2 * play, 2 * tall, align=FRONT)
    return body + stud(0, 0, pin_d / 2, air + thick, -1)


def flat(slat, wide, thick, pin_d, play, holes):
    outline = Pos(slat / 2, 0) * SlotCenterToCenter(slat, wide)
    for x in holes:
        outline -= Pos(x, 0) * Circle(pin_d / 2 + play)
    return FLAT * extrude(outline, thick)


def rising(slat, wide, thick, air, pin_d, play):
    body = flat(slat, wide, thick, pin_d, play, [])
    for x in (0, slat / 2, slat):
        body += stud(x, 0, pin_d / 2, -1, -2 * thick - air)
    return body


def rising_first(slat, wide, thick, air, pin_d, play):
    body = flat(slat, wide, thick, pin_d, play, [0])
    for x in (slat / 2, slat):
        body += stud(x, 0, pin_d / 2, -1, -2 * thick - air)
    return body


def falling(slat, wide, thick, pin_d, play):
    return flat(slat, wide, thick, pin_d, play, [0, slat / 2, slat])
