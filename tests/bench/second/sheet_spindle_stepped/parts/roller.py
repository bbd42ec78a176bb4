from build123d import Axis, Plane, Polyline, make_face, revolve


def roller(bore, outer=32, long=44, flange=40, flange_high=5):
    inner, r, rim = bore / 2, outer / 2, flange / 2
    outline = Polyline((inner, 0), (rim, 0), (rim, flange_high), (r, flange_high), (r, long), (inner, long), (inner, 0))
    return revolve(Plane.XZ * make_face(outline), Axis.Z)
