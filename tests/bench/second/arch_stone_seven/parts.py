from build123d import Align, Axis, Box, Plane, Pos, Rectangle, revolve

OUTWARDS = (Align.MAX, Align.CENTER, Align.MAX)


def abutment(base_long, deep, base_high):
    """A block below z = 0; its inner face is x = 0."""
    return Box(base_long, deep, base_high, align=OUTWARDS)


def voussoir(inner, outer, deep, share_deg):
    """From the plane z = 0 upwards about -y, as the right springer lies."""
    section = Plane.XY * Pos((inner + outer) / 2, 0) * Rectangle(outer - inner, deep)
    return revolve(section, Axis((0, 0, 0), (0, -1, 0)), share_deg)
