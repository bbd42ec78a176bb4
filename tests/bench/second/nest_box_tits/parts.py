from build123d import Align, Box, Circle, Plane, Pos, Rectangle, extrude


def back(wide, board, back_high):
    return Box(wide, board, back_high, align=(Align.CENTER, Align.MIN, Align.MIN))


def side(board, room, high):
    return Box(board, room, high, align=Align.MIN)


def base(room, board, drain=8, drains_apart=80):
    """The floor on z = 0; two holes on its diagonal."""
    floor = Rectangle(room, room)
    for sign in (-1, 1):
        floor -= Pos(sign * drains_apart / 2, sign * drains_apart / 2) * Circle(drain / 2)
    return extrude(floor, board)


def front(wide, high, board, entrance=32, below=60):
    """A board whose top edge is z = 0, its face y = 0."""
    face = Pos(0, -high / 2) * Rectangle(wide, high) - Pos(0, -below) * Circle(entrance / 2)
    return extrude(Plane.XZ * face, -board)


def roof(roof_side, board):
    return Box(roof_side, roof_side, board, align=(Align.CENTER, Align.MAX, Align.MIN))
