from build123d import Align, Box, Pos

B = (Align.CENTER, Align.MAX, Align.MIN)


def build(part):
    d = part.dimensions
    body = Box(d.inner + 2 * d.board, d.depth, d.high, align=B)
    body -= Pos(0, -d.back, d.board) * Box(d.inner, d.depth, d.high - 2 * d.board, align=B)
    return part.made(body)
