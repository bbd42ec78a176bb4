from build123d import Align, Box, Locations, Plane, Polyline, extrude, make_face

BACK = (Align.CENTER, Align.MAX, Align.MIN)


def organiser(wide, deep, high=90, wall=3, bottom=3, front=50, level=30):
    """A side's outline carried across, less three equal wells; level is how much of the sides' top is level at the back."""
    side = Polyline((0, 0), (0, high), (-level, high), (wall - deep, front), (-deep, front), (-deep, 0), close=True)
    body = extrude(Plane.YZ * make_face(side), wide / 2, both=True)
    well = (wide - 4 * wall) / 3
    for shift in (-well - wall, 0, well + wall):
        with Locations((shift, -wall, bottom)):
            body -= Box(well, deep - 2 * wall, high, align=BACK)
    return body
