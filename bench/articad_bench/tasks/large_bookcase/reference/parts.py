from build123d import Align, Box, Cylinder, Pos, Rot

CORNER = (Align.MIN, Align.MIN, Align.MIN)
LOW = (Align.CENTER, Align.CENTER, Align.MIN)
RIGHT = Rot(Y=90)  # turns z into x


def bottom(width, reach, board, pitch, x1, up_count, axis_y, lip="lip"):
    """A board over the whole width, with a blind hole for the pivot of each door on its inner face."""
    body = Box(width, reach, board, align=CORNER)
    for pair in (0, 2 * pitch):
        for x in (x1, 2 * pitch + board - x1):
            body -= Pos(pair + x, lip + axis_y, board - 10 if up_count else 0) * Cylinder(4, 10, align=LOW)
    return body


top = bottom


def back(width, tall, thick):
    return Box(width, thick, tall, align=CORNER)


def upright(board, depth, high, left_count, right_count):
    body = Box(board, depth, high, align=CORNER)
    for z in (500, 1000, 1500):
        for y in (40, depth - 40):
            if left_count:
                body -= Pos(0, y, z - board) * RIGHT * Cylinder(2.5, 16)
            if right_count:
                body -= Pos(board, y, z - board) * RIGHT * Cylinder(2.5, 16)
    return body


def shelf(long, wide, board):
    return Box(long, wide, board, align=CORNER)


def pin(across, long):
    return RIGHT * Cylinder(across / 2, long)


def door(leaf, high, board):
    """Its frame is on the axis of its pivots, at its lower edge."""
    body = Pos(leaf / 2 - 12, 0, 0) * Box(leaf, board, high, align=LOW)
    for z in (-1, high - 19):
        body -= Pos(0, 0, z) * Cylinder(4.1, 20, align=LOW)
    return body


def pivot_low(across, long):
    return Cylinder(across / 2, long, align=LOW)


pivot_top = pivot_low


def handle(long, bar, out):
    body = Pos(0, -out, 0) * Box(bar, bar, long, align=(Align.CENTER, Align.MIN, Align.CENTER))
    for z in (-1, 1):
        body += Pos(0, 0, z * (long / 2 - 20)) * Rot(X=90) * Cylinder(5, out - 2, align=LOW)
    return body
