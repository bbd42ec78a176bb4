from build123d import Align, Axis, Box, Cylinder, Pos, Rot, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def housing(
    axis_z, long=180, wide=100, high=90, wall=8, left=40, right=52, apart=80, flange=16, flange_thick=10, hole=6.6, corner=6,
):
    """The cavity's upright corners are rounded as a core leaves them; the bolts lie in the middle of what sticks out."""
    body = Pos(0, 0, -axis_z) * Box(long, wide, high, align=UP)
    body += Pos(0, 0, high - axis_z - flange_thick) * Box(long + 2 * flange, wide + 2 * flange, flange_thick, align=UP)
    core = Pos(0, 0, wall - axis_z) * Box(long - 2 * wall, wide - 2 * wall, high, align=UP)
    body -= fillet(core.edges().filter_by(Axis.Z), corner)
    for x, diameter in ((-apart / 2, left), (apart / 2, right)):
        body -= Pos(x, 0, 0) * Rot(X=90) * Cylinder(diameter / 2, 2 * wide)
    reach = long / 2 + flange / 2, wide / 2 + flange / 2
    for x in (-reach[0], 0, reach[0]):
        for y in (-reach[1], reach[1]):
            body -= Pos(x, y, high - axis_z) * Cylinder(hole / 2, 4 * flange_thick)
    return body
