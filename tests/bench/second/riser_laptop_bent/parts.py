from build123d import Axis, BuildLine, BuildSketch, Circle, FilletPolyline, GridLocations, Plane, Pos, extrude, fillet, trace


def riser(wide, deep, high, sheet, hole_d, pitch, bend=5, foot=28, columns_count=5, rows_count=2):
    """The middle line of the sheet from the front foot over the top to the back foot; both feet turn inwards."""
    t = sheet / 2
    with BuildSketch(Plane.YZ) as profile:
        with BuildLine():
            FilletPolyline((foot, t), (t, t), (t, high - t), (deep - t, high - t), (deep - t, t), (deep - foot, t), radius=bend + t)
        trace(line_width=sheet)
    body = extrude(profile.sketch, wide)
    corners = body.edges().filter_by(Axis.Z).filter_by(lambda e: foot - 1 < e.center().Y < deep - foot + 1)
    body = fillet(corners, 6)
    with BuildSketch(Plane.XY.offset(high - 2 * sheet)) as holes:
        with GridLocations(pitch, pitch, columns_count, rows_count):
            Circle(hole_d / 2)
    return body - Pos(wide / 2, deep / 2, 0) * extrude(holes.sketch, 4 * sheet)
