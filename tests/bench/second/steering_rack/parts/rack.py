from build123d import Align, Box, Cylinder, Pos

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def rack(rack_ends, rack_wide, link, gap, pin_d, bar=6, bar_high=5, end=193):
    """A bar with square ends that run in the guides; z = 0 is its lower face."""
    body = Box(rack_ends + 20, rack_wide, link, align=UP)
    body += Pos(0, 0, 3.5 - bar_high / 2) * Box(2 * end, bar, bar_high, align=UP)
    for side in (-1, 1):
        body += Pos(side * rack_ends / 2, 0, link / 2) * Cylinder(pin_d / 2, link + link / 2 + gap, align=UP)
    return body
