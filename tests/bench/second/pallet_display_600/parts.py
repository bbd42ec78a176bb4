from build123d import Align, Box

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def bearer(bearer_wide, deep, bearer_high):
    return Box(bearer_wide, deep, bearer_high, align=UP)


def deck(long, board_wide, board):
    return Box(long, board_wide, board, align=UP)
