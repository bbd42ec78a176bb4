from build123d import Axis, Plane, Polyline, make_face, revolve


def bush(bush, bush_bore, flange, knuckle, sleeve=16):
    inner, outer, rim = bush_bore / 2, bush / 2, knuckle / 2
    outline = Polyline((inner, -flange), (rim, -flange), (rim, 0), (outer, 0), (outer, sleeve), (inner, sleeve), (inner, -flange))
    return revolve(Plane.XZ * make_face(outline), Axis.Z)
