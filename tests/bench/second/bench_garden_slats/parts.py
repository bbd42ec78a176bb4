from build123d import Align, Axis, Box, Plane, Polyline, extrude, fillet, make_face

ACROSS = (Align.CENTER, Align.MIN, Align.MIN)


def side_left(iron, deep, seat_z, post, leg=40, rail=45, high=800, inner=25):
    """Side frame from x = 0 to iron: front leg, seat rail and back post in one piece."""
    outline = Polyline(
        (0, 0),
        (leg, 0),
        (leg, seat_z - rail),
        (deep - post, seat_z - rail),
        (deep - post, 0),
        (deep, 0),
        (deep, high),
        (deep - post, high),
        (deep - post, seat_z),
        (0, seat_z),
        close=True,
    )
    body = extrude(Plane.YZ * make_face(outline), iron)
    under = [e for e in body.edges().filter_by(Axis.X) if abs(e.center().Z - seat_z + rail) < 1]
    return fillet(under, inner)


def slat(long, wide, slat, rounded=3):
    """A board on z = 0 from y = 0 to its width; its upper edges are rounded."""
    body = Box(long, wide, slat, align=ACROSS)
    return fillet(body.edges().filter_by(Axis.X).group_by(Axis.Z)[-1], rounded)


side_right = side_left
seat_front = seat_middle = seat_rear = back_lower = back_upper = slat
