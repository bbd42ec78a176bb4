from build123d import Axis, Circle, GridLocations, Plane, Polyline, Rectangle, extrude, make_face, revolve


def plate(thick, bush_d, pitch, long=120, wide=60, dowel=6, dowels_apart=100):
    """Its upper face is z = 0."""
    face = Rectangle(long, wide) - GridLocations(pitch, 1, 3, 1) * Circle(bush_d / 2) - GridLocations(dowels_apart, 1, 2, 1) * Circle(dowel / 2)
    return extrude(face, -thick)


def bushing(thick, bush_d, collar_d=24, long=16, bore=8):
    """A headed bushing whose collar lies on z = 0."""
    high = long - thick
    half = Polyline((bore / 2, -thick), (bush_d / 2, -thick), (bush_d / 2, 0), (collar_d / 2, 0), (collar_d / 2, high), (bore / 2, high), close=True)
    return revolve(Plane.XZ * make_face(half), Axis.Z)
