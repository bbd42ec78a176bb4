from math import cos, radians, sin

from build123d import Align, Box, Circle, Cylinder, Pos, SlotCenterToCenter, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)
CORNER = (Align.MIN, Align.MIN, Align.MIN)


def frame(in_x, out_x, shaft_y, shaft_d, play, wide=160, deep=180, low=7.6, tall=76, plate=10):
    """Two plates and a wall at the back; the lower plate holds the input shaft, the upper one the output shaft."""
    body = Pos(0, 0, low) * Box(wide, deep, tall, align=CORNER)
    body -= Pos(-1, -plate, low + plate) * Box(wide + 2, deep, tall - 2 * plate, align=CORNER)
    bore = Cylinder(shaft_d / 2 + play, tall / 2, align=UP)
    return body - Pos(in_x, shaft_y, 0) * bore - Pos(out_x, shaft_y, low + tall / 2 + 1) * bore


def disc(disc_d, thick, pin_r, pin_d, pin_play):
    """From z = 0 to thick with three holes, the first on x."""
    flat = Circle(disc_d / 2)
    for turn in (0, 120, 240):
        flat -= Pos(pin_r * cos(radians(turn)), pin_r * sin(radians(turn))) * Circle(pin_d / 2 + pin_play)
    return extrude(flat, thick)


def disc_in(disc_d, thick, pin_r, pin_d, pin_play, shaft_d, stub):
    return disc(disc_d, thick, pin_r, pin_d, pin_play) + Cylinder(shaft_d / 2, stub, align=(Align.CENTER, Align.CENTER, Align.MAX))


def disc_out(disc_d, thick, pin_r, pin_d, pin_play, shaft_d, stub):
    return disc(disc_d, thick, pin_r, pin_d, pin_play) + Pos(0, 0, thick) * Cylinder(shaft_d / 2, stub, align=UP)


def disc_mid(disc_d, thick, pin_r, pin_d, pin_play):
    return disc(disc_d, thick, pin_r, pin_d, pin_play)


def link(link_long, thick, gap, pin_d, wide=14, short=0.2):
    """Its pins reach not quite half through a disc, since two of them meet in the middle one."""
    body = extrude(Pos(link_long / 2, 0) * SlotCenterToCenter(link_long, wide), thick)
    reach = gap + thick / 2 - short
    body += Pos(0, 0, -reach) * Cylinder(pin_d / 2, reach + 1, align=UP)
    return body + Pos(link_long, 0, thick - 1) * Cylinder(pin_d / 2, reach + 1, align=UP)


link_low = link_high = link
