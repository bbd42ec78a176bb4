from build123d import Align, Box

BEHIND = (Align.CENTER, Align.MAX, Align.MIN)


def back(wide, skin, high):
    """From its rear face, y = 0, forwards."""
    return Box(wide, skin, high, align=BEHIND)


def side(board, carcase, high):
    return Box(board, carcase, high, align=Align.MIN)


def board(inside, carcase, board):
    """From its rear edge, y = 0, forwards."""
    return Box(inside, carcase, board, align=BEHIND)
