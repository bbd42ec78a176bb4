"""Parts of the shelf, all in the frame of the assembly."""

from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.MIN, Align.MIN, Align.MIN)


def block(x, y, z):
    """Return a box between two values of each coordinate."""
    return Pos(min(x), min(y), min(z)) * Box(abs(x[1] - x[0]), abs(y[1] - y[0]), abs(z[1] - z[0]), align=LOW)


def rail(width, rail, rail_low, rail_high, hole, inset):
    body = block((-width / 2, width / 2), (-rail, 0), (rail_low, rail_low + rail_high))
    for x in (inset - width / 2, 0, width / 2 - inset):
        body -= Pos(x, -rail / 2, rail_low + rail_high / 2) * Rot(90, 0, 0) * Cylinder(hole / 2, 2 * rail)
    return body


def side(width, depth, height, side, board, housing, rail, rail_low, rail_high, out):
    outer, inner = out * width / 2, out * (width / 2 - side)
    body = block((outer, inner), (-depth, 0), (0, height))
    body -= block((outer, inner), (-rail, 0), (rail_low, rail_low + rail_high))
    for low in (0, (height - board) / 2, height - board):
        body -= block((inner, inner + out * housing), (-depth, 0), (low, low + board))
    return body


def shelf(width, depth, board, side, housing, low):
    half = width / 2 - side + housing
    return block((-half, half), (-depth, 0), (low, low + board))
