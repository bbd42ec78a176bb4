from build123d import Align, Box, Circle, Cylinder, Plane, Pos, Rectangle, Rot, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def dowel(dowel_d, long):
    return Rot(Y=90) * Cylinder(dowel_d / 2, long)


def bottom(long, wide, board):
    return Box(long, wide, board, align=UP)


def end(end_wide, end_high, board, dowel_d, dowel_up):
    """From its outer face, x = 0, inwards along +x."""
    face = Pos(0, end_high / 2 - dowel_up) * Rectangle(end_wide, end_high) - Circle(dowel_d / 2)
    return extrude(Plane.YZ * face, board)


def side(long, board, side_high):
    """From its outer face, y = 0, inwards along +y; its upper edge is z = 0."""
    return Box(long, board, side_high, align=(Align.CENTER, Align.MIN, Align.MAX))
