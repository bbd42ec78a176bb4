from math import hypot

from build123d import Align, Box, Pos, Rectangle, loft

TOP = (Align.CENTER, Align.CENTER, Align.MAX)


def tin(high, rim_x=250, rim_y=110, narrower=16, sheet=1, lip=6):
    """A tapered tin below z = 0, of the same thickness everywhere."""
    slope = narrower / 2 / high

    def section(depth, inset):
        less = 2 * (inset + slope * depth)
        return Pos(0, 0, -depth) * Rectangle(rim_x - less, rim_y - less)

    beside = sheet * hypot(1, slope)
    tub = loft([section(0, 0), section(high, 0)], ruled=True)
    flange = Box(rim_x + 2 * lip, rim_y + 2 * lip, sheet, align=TOP)
    return tub + flange - loft([section(0, beside), section(high - sheet, beside)], ruled=True)
