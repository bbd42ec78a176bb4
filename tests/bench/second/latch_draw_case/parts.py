from build123d import Align, Box, Cylinder, Pos, Rot

UP = (Align.CENTER, Align.CENTER, Align.MIN)
MIN_X = (Align.MIN, Align.CENTER, Align.CENTER)
Y = Rot(90, 0, 0)


def board(board_long, board_wide, board_thick):
    return Box(board_long, board_wide, board_thick, align=UP)


def base(pivot_z, pin_d, lever_wide, ear, sole=3, front=18, rear=22, ear_long=16):
    """Plate with two ears and the lever's pin riveted in them."""
    inner = lever_wide + 1
    body = Pos(-rear, 0, 0) * Box(front + rear, inner + 2 * ear, sole, align=(Align.MIN, Align.CENTER, Align.MIN))
    for side in (-1, 1):
        y = side * (inner + ear) / 2
        body += Pos(0, y, 0) * Box(ear_long, ear, pivot_z, align=UP) + Pos(0, y, pivot_z) * Y * Cylinder(ear_long / 2, ear)
    return body + Pos(0, 0, pivot_z) * Y * Cylinder(pin_d / 2, inner + 2 * ear)


def lever(lever_wide, pin_d, play, stud_x, stud_d, long=40, thick=8, boss=14, stud_long=33):
    body = Y * Cylinder(boss / 2, lever_wide) + Box(long, lever_wide, thick, align=MIN_X)
    body += Pos(stud_x, 0, 0) * Y * Cylinder(stud_d / 2, stud_long)
    return body - Y * Cylinder(pin_d / 2 + play, 2 * lever_wide)


def bow(stud_d, play, reach, inner=24.5, leg=3, high=5, wire=5, eye=10):
    body = Pos(reach, 0, 0) * Y * Cylinder(wire / 2, inner + 2 * leg)
    for side in (-1, 1):
        y = side * (inner + leg) / 2
        body += Pos(0, y, 0) * Box(reach, leg, high, align=MIN_X) + Pos(0, y, 0) * Y * Cylinder(eye / 2, leg)
    return body - Y * Cylinder(stud_d / 2 + play, 3 * inner)


def catch(sole=3, wide=18, rear=18, front=12, post=6, tall=16, lip_end=10, lip=4):
    """Foot from -rear to front; the post stands at -post to 0, its lip points to +x."""
    low = (Align.MIN, Align.CENTER, Align.MIN)
    body = Pos(-rear, 0, 0) * Box(front + rear, wide, sole, align=low) + Pos(-post, 0, 0) * Box(post, wide, tall, align=low)
    return body + Pos(-post, 0, tall - lip) * Box(post + lip_end, wide, lip, align=low)
