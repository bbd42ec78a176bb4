from build123d import Align, Axis, BuildLine, BuildSketch, Cylinder, Plane, Polyline, Pos, Rot, extrude, fillet, make_face

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def bow(
    thick, axis_z, play, spindle_d, barrel_d, leg_x, barrel_end, pivot_x, pivot_z, pivot_d, high=60, leg=15, foot=15, wide=65, seat=10
):
    with BuildSketch(Plane.XZ) as outline:
        with BuildLine():
            Polyline((0, 0), (wide, 0), (wide, high), (leg_x, high), (leg_x, foot), (leg, foot), (leg, high), (0, high), close=True)
        make_face()
    plate = extrude(outline.sketch, -thick)
    inner = [e for e in plate.edges().filter_by(Axis.Y) if abs(e.center().Z - foot) < 0.1]
    plate = fillet(inner, 2)
    along = Pos(0, thick / 2, axis_z) * Rot(Y=90)
    plate += along * Pos(0, 0, wide - 1) * Cylinder(barrel_d / 2, barrel_end - wide + 1, align=UP)
    plate -= along * Pos(0, 0, leg_x - 1) * Cylinder(spindle_d / 2 + play, barrel_end - leg_x + 2, align=UP)
    plate -= along * Pos(0, 0, leg - seat) * Cylinder(spindle_d / 2, seat + 1, align=UP)
    plate += Pos(pivot_x, 3, pivot_z) * Rot(X=90) * Cylinder(pivot_d / 2, 8, align=UP)
    return plate + Pos(pivot_x, -3.9, pivot_z) * Rot(X=90) * Cylinder(pivot_d / 2 + 0.35, 1.1, align=UP)
