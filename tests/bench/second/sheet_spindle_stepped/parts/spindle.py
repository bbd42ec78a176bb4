from build123d import Align, Axis, Cylinder, Plane, PolarLocations, Polyline, Pos, Rot, make_face, revolve

HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def spindle(
    collar_top, journal_top, top, groove_z, groove_high, groove, upper_groove_z, upper_groove_high, upper_groove, journal, tail,
    flange=56, flange_high=7, collar=26, circle=44, screw=5.5, drill=6, drill_deep=18, cross=4, cross_z=92,
):
    steps = [(flange, 0, flange_high), (collar, flange_high, collar_top), (journal, collar_top, groove_z), (groove, groove_z, groove_z + groove_high)]
    steps += [(journal, groove_z + groove_high, journal_top), (tail, journal_top, upper_groove_z)]
    steps += [(upper_groove, upper_groove_z, upper_groove_z + upper_groove_high), (tail, upper_groove_z + upper_groove_high, top)]
    corners = [(wide / 2, -z) for wide, *ends in steps for z in ends]
    deep = drill_deep - top
    outline = [(0, 0), *corners, (drill / 2, -top), (drill / 2, deep), (0, deep), (0, 0)]
    shaft = revolve(Plane.XZ * make_face(Polyline(*outline)), Axis.Z)
    shaft -= PolarLocations(circle / 2, 3) * Cylinder(screw / 2, flange_high, align=HIGH)
    return shaft - Pos(Z=-cross_z) * Rot(Y=90) * Cylinder(cross / 2, 2 * tail)
