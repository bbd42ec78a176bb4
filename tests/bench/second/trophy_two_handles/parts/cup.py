from math import hypot

from build123d import Axis, Plane, Polyline, make_face, revolve


def cup(cup_low_d, cup_top_d, cup_high, wall, bottom):
    """A conical cup on z = 0 whose wall is equally thick, measured across it."""
    low, top = cup_low_d / 2, cup_top_d / 2
    slope = (top - low) / cup_high
    across = wall * hypot(1, slope)
    half = Polyline((0, 0), (low, 0), (top, cup_high), (top - across, cup_high), (low + slope * bottom - across, bottom), (0, bottom), close=True)
    return revolve(Plane.XZ * make_face(half), Axis.Z)
