"""Frame and legs stand on the floor; a half's frame is at the table's middle in the upper face."""

from build123d import Align, Axis, Box, Pos, chamfer, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)
LOW = (Align.MIN, Align.MIN, Align.MIN)


def frame(frame_long, frame_wide, apron_z, frame_z, leg_x, leg_y, neck, rail_in, rail_out, tongue, deep, board=32, block=85, rail=19.5):
    """Four aprons, corner blocks with sockets for the legs, and two rails grooved on both sides."""
    tall = frame_z - apron_z
    body = Pos(0, 0, apron_z) * (Box(frame_long, frame_wide, tall, align=UP) - Box(frame_long - 2 * board, frame_wide - 2 * board, tall, align=UP))
    body = chamfer(body.edges().filter_by(Axis.Z).group_by(Axis.X)[0], 3)
    for x in (-leg_x, leg_x):
        for y in (-leg_y, leg_y):
            body += Pos(x, y, apron_z) * Box(block, block, tall, align=UP)
            body -= Pos(x, y, apron_z - 1) * Box(neck, neck, tall + 2, align=UP)
    for side in (-1, 1):
        bar = Box(frame_long - 40, rail_out - rail_in, rail, align=UP)
        for face in (-1, 1):
            bar -= Pos(0, face * (rail_out - rail_in) / 2, rail / 2) * Box(2 * frame_long, 2 * (deep - 1), tongue + 1)
        body += Pos(0, side * (rail_in + rail_out) / 2, frame_z) * bar
    return body


def half(side, long, wide, top, high, frame_z, runner, tooth, gap, tongue, deep, air, bar=20, under=200, end=480, rail=19.5):
    """Half of the top with two runners that reach under the other half."""
    plate = Pos(side * (long / 4 + gap / 4), 0, -top) * Box(long / 2 - gap / 2, wide, top, align=UP)
    plate = fillet(plate.edges().filter_by(Axis.Z).group_by(Axis.X)[-1 if side > 0 else 0], 15)
    floor, roof = frame_z + 0.5 - high, -top
    for face in (-1, 1):
        y = face * (runner - tooth * bar / 2)
        plate += Pos(side * (gap + end) / 2, y, floor) * Box(end - gap, bar, roof - floor + 1, align=UP)
        plate += Pos(side * (end - under) / 2, y, floor) * Box(end + under, bar, roof - floor - 1, align=UP)
        middle = frame_z + rail / 2 - high
        plate += Pos(side * (end - under) / 2, face * (runner + tooth * (deep - air - 3) / 2 - tooth * 1.5), middle) * Box(end + under, deep - air - 3 + 3, tongue)
    return plate


half_right = half_left = half


def leg(leg, neck, collar_z, apron_z, frame_z):
    shaft = Box(neck, neck, frame_z, align=UP)
    shaft = chamfer(shaft.edges().group_by(Axis.Z)[0], 3)
    return shaft + Pos(0, 0, collar_z) * Box(leg, leg, apron_z - collar_z, align=UP)


leg_front = leg_back = leg_front_left = leg_front_right = leg_back_left = leg_back_right = leg
