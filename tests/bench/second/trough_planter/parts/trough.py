from build123d import Align, Box, Circle, GridLocations, Pos, Rectangle, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def trough(high, long=700, wide=220, wall=25, base=30, feet=60, feet_high=20, hole=15, pitch=120):
    """Rim on z = 0, feet at z = high; the holes are in the middle and one and two pitches from it, the feet one and a half."""
    ring = Rectangle(long, wide) - Rectangle(long - 2 * wall, wide - 2 * wall)
    floor = Rectangle(long, wide) - GridLocations(pitch, 1, 5, 1) * Circle(hole / 2)
    inner = high - feet_high - base
    body = extrude(ring, inner) + Pos(0, 0, inner) * extrude(floor, base)
    for x in (-1.5 * pitch, 1.5 * pitch):
        body += Pos(x, 0, inner + base) * Box(feet, wide, feet_high, align=UP)
    return body
