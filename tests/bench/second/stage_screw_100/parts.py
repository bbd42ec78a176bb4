from build123d import Align, Axis, Box, Cylinder, Pos, Rot, chamfer

UP = (Align.CENTER, Align.CENTER, Align.MIN)
RIGHT = (Align.MIN, Align.CENTER, Align.MIN)


def along_x(y, z, start, end, diameter):
    return Pos(start, y, z) * Rot(Y=90) * Cylinder(diameter / 2, end - start, align=UP)


def base(axis_z, rail_d, rails, screw_d, journal_d, play, block, left_x, right_x, long=240, wide=80, plate=10, top=50):
    body = Box(long, wide, plate, align=RIGHT)
    for x in (left_x, right_x):
        body += Pos(x, 0, 0) * Box(block, wide, top, align=RIGHT)
    for y in (-rails / 2, rails / 2):
        body += along_x(y, axis_z, left_x + 1, right_x + block - 1, rail_d)
    body -= along_x(0, axis_z, right_x - 1, right_x + block + 1, screw_d + 2 * play)
    return body - along_x(0, axis_z, left_x + 8, left_x + block + 1, journal_d + 2 * play)


def carriage(axis_z, rail_d, rails, screw_d, play, carriage, wide=76, low=16, high=52):
    """A block from x = 0 with three bores."""
    body = Pos(0, 0, low - axis_z) * Box(carriage, wide, high - low, align=RIGHT)
    for y in (-rails / 2, rails / 2):
        body -= along_x(y, 0, -1, carriage + 1, rail_d + 2 * play)
    return body - along_x(0, 0, -1, carriage + 1, screw_d + 0.2)


def screw(screw_d, journal_d, block, left_x, right_x, collar, knob_x, knob, end_d=6):
    """The right block's inner face is x = 0; a collar on either side of the block, a journal in the left block."""
    left = left_x + block - right_x
    body = along_x(0, 0, left + 1, block + 1, screw_d) + along_x(0, 0, left - 10, left + 2, journal_d)
    body += along_x(0, 0, -collar - 0.3, -0.3, 16) + along_x(0, 0, block + 0.3, block + 0.3 + collar - 1, 16)
    return body + along_x(0, 0, block, knob_x - right_x + knob - 3, end_d)


def knob(knob, end_d=6, across=30):
    body = along_x(0, 0, 0, knob, across)
    body = chamfer(body.edges().group_by(Axis.X)[-1], 1)
    return body - along_x(0, 0, -1, knob - 3, end_d)
