from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.MIN, Align.MIN, Align.MIN)
UP = (Align.CENTER, Align.CENTER, Align.MIN)


def stand(axis_x, axis_z, board_y, rod_y, rod_z, rod_d, axle_d, deep=70, base=16, board=8, high=192, end=14, end_high=28):
    long = 2 * axis_x
    frame = Box(long, deep, base, align=LOW)
    frame += Pos(0, board_y, base / 2) * Box(long, board, high - base / 2, align=LOW)
    frame += Pos(axis_x, board_y + board / 2, axis_z) * Rot(X=90) * Cylinder(axle_d / 2, board / 2 + 7.5, align=UP)
    front = 2 * rod_y - board_y + 2
    for side in (-1, 1):
        z = axis_z + side * rod_z
        for x in (0, long - end):
            frame += Pos(x, front, z - end_high / 2) * Box(end, board_y - front + board / 2, end_high, align=LOW)
        frame += Pos(end / 2, rod_y, z) * Rot(Y=90) * Cylinder(rod_d / 2, long - end, align=UP)
    return frame
