from build123d import Align, Box, Cylinder, Locations, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = (Align.CENTER, Align.MIN, Align.MIN)


def carcass(wide, deep, high, board, thin, row, low, open_wide, column, foot_x, foot_y, spigot, spigot_long, back=8):
    body = Box(wide, deep, high, align=FRONT)
    for z, opening in ((board, low), (board + low + thin, row), (2 * board + low + thin + row, row)):
        for x in (-column, column):
            body -= Pos(x, -back, z) * Box(open_wide, deep, opening, align=FRONT)
    places = [(x, y) for x in (-foot_x, foot_x) for y in (foot_y, deep - foot_y)]
    return body - Locations(*places) * Cylinder(spigot / 2, spigot_long, align=LOW)
