from math import hypot

from build123d import Axis, Plane, Polyline, make_face, revolve


def funnel(cone_high, spout_long, rim_d=120, spout_d=16, sheet=1.5, lip=4):
    """The wall's section, turned about z; sheet is measured across the wall everywhere."""
    rim, spout, end = rim_d / 2, spout_d / 2, -cone_high - spout_long
    slope = (rim - spout) / cone_high
    inner_rim = rim - sheet * hypot(1, slope)
    knee = -(inner_rim - (spout - sheet)) / slope  # where the inner cone meets the inner cylinder
    wall = Polyline(
        (spout, end), (spout, -cone_high), (rim - slope * sheet, -sheet), (rim + lip, -sheet), (rim + lip, 0),
        (inner_rim, 0), (spout - sheet, knee), (spout - sheet, end), close=True,
    )
    return revolve(Plane.XZ * make_face(wall), Axis.Z)
