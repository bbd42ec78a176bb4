from build123d import Align, Box, Plane, Polyline, extrude, make_face

BACK_TOP = (Align.CENTER, Align.MAX, Align.MAX)


def side(deep, high, step, half, board):
    """A stepped panel, y along its depth, towards +x."""
    outline = Polyline((0, 0), (deep, 0), (deep, high), (half, high), (half, step), (0, step), close=True)
    return extrude(Plane.YZ * make_face(outline), board)


def tread(inside, half, board):
    return Box(inside, half, board, align=BACK_TOP)


def brace(inside, brace_high, board):
    return Box(inside, board, brace_high, align=BACK_TOP)
