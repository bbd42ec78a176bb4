"""Boards and doors of the bookcase wall; each in a frame at its joint."""

from build123d import Align, Box, Cylinder, GeomType, Pos, Rot, chamfer

UP = (Align.CENTER, Align.CENTER, Align.MIN)
BACK = (Align.CENTER, Align.MIN, Align.MIN)


def long_board(long, board, deep, lip, pitch, pivot_d, door_wide, pivot_edge, pivot_y, hole_z, hole_long):
    body = Pos(0, -lip, 0) * Box(long, deep + lip, board, align=BACK)
    for bay in range(4):
        side = -1 if bay % 2 == 0 else 1
        x = (bay - 1.5) * pitch + side * (door_wide / 2 - pivot_edge)
        body -= Pos(x, pivot_y, hole_z) * Cylinder(pivot_d / 2, hole_long, align=UP)
    return body


def bottom(long, board, deep, lip, pitch, pivot_d, door_wide, pivot_edge, pivot_y, pivot_in):
    return long_board(long, board, deep, lip, pitch, pivot_d, door_wide, pivot_edge, pivot_y, board - pivot_in, 2 * pivot_in)


def top(long, board, deep, lip, pitch, pivot_d, door_wide, pivot_edge, pivot_y, pivot_in):
    return long_board(long, board, deep, lip, pitch, pivot_d, door_wide, pivot_edge, pivot_y, -pivot_in, 2 * pivot_in)


def upright(board, deep, inside, high, step, shelf_y, shelf_deep, pin_d, pin_long, pin_apart, drill_left_count, drill_right_count):
    body = Box(board, deep, inside, align=BACK)
    sides = [-1] * drill_left_count + [1] * drill_right_count
    for side in sides:
        for level in (-1, 0, 1):
            z = high / 2 - 1.5 * board + level * step - pin_d / 2
            for y in (-1, 1):
                at = Pos(side * board / 2, shelf_y + shelf_deep / 2 + y * pin_apart / 2, z)
                body -= at * Rot(0, 90, 0) * Cylinder(pin_d / 2, pin_long)
    return body


def back(long, back_thick, high):
    return Box(long, back_thick, high, align=BACK)


def shelf(shelf_long, shelf_deep, board):
    return Box(shelf_long, shelf_deep, board, align=BACK)


def bevelled(diameter, long, bevel=0.5):
    body = Cylinder(diameter / 2, long, align=UP)
    return chamfer(body.edges().filter_by(GeomType.CIRCLE), bevel)


def pin(pin_d, pin_long):
    return Pos(-pin_long / 2, 0, 0) * Rot(0, 90, 0) * bevelled(pin_d, pin_long)


def pivot(pivot_d, pivot_long):
    return bevelled(pivot_d, pivot_long)


def door(door_wide, door_high, board, pivot_d, pivot_play, pivot_edge, pivot_long, pivot_in, inside, hand, spare=1):
    """Hand 1: the door reaches to +x from its pivots, -1: to -x."""
    body = Pos(hand * (door_wide / 2 - pivot_edge), 0, 0) * Box(door_wide, board, door_high)
    end = inside / 2 + pivot_in - pivot_long - spare
    for side in (-1, 1):
        body -= Pos(0, 0, side * (end + door_high / 2)) * Cylinder((pivot_d + pivot_play) / 2, door_high)
    return body


def handle(bar=160, bar_wide=12, out=32, bar_thick=10, foot=128):
    """A flat bar on two round feet, before the door (toward -y)."""
    body = Pos(0, bar_thick / 2 - out, 0) * Box(bar_wide, bar_thick, bar)
    for side in (-1, 1):
        body += Pos(0, -out / 2 + 1, side * foot / 2) * Rot(90, 0, 0) * Cylinder(bar_wide / 2 - 1, out - 2)
    return body
