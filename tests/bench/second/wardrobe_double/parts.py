from build123d import Align, Box, Cone, Cylinder, Pos, Rot, Sphere

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)
BACK = (Align.CENTER, Align.MIN, Align.MIN)
FRONT = (Align.CENTER, Align.MAX, Align.MIN)
HEAD = 2  # thickness of a pin's head


def case(wide, deep, high, board, leg, divider, forward, pin, pin_x, pin_y, rear=10):
    """Sides, top, divider, bottom, rear wall and the partition of the drawers in one."""
    inner = wide - 2 * board
    body = Pos(0, 0, leg) * Box(wide, deep, high - leg, align=BACK)
    body -= Pos(0, -1, divider + board) * Box(inner, deep - rear + 1, high - divider - 2 * board, align=BACK)
    for x in (-1, 1):
        body -= Pos(x * (inner + board) / 4, -1, leg + board) * Box((inner - board) / 2, deep - rear + 1, divider - leg - board, align=BACK)
    for z in (divider, high - board):
        body += Pos(0, 1, z) * Box(wide, forward + 1, board, align=FRONT)
    for x in (-pin_x, pin_x):
        body -= Pos(x, pin_y, 0) * Cylinder(pin / 2, 3 * high)
    return body


def leg(leg):
    """Below z = 0, tapered."""
    return Cone(14, 24, leg, align=DOWN)


leg_front_l = leg_back_l = leg


def pin(pin, pin_long):
    """Shank below z = 0 and a flat head on it."""
    return Cylinder(pin / 2, pin_long, align=DOWN) + Cylinder(pin / 2 + 3, HEAD, align=UP)


pin_upper_l = pin_lower_l = pin


def door_l(wide, high, board, divider, door, gap, pin, pin_x, pin_long, play):
    """Round at its hung edge, about its pins; the knob is near the middle of the wardrobe."""
    tall = high - divider - 2 * board - 2 * gap
    body = Pos(pin_x / 2 - gap / 2, 0, gap) * Box(pin_x - gap, door, tall, align=UP) + Pos(0, 0, gap) * Cylinder(door / 2, tall, align=UP)
    for z in (0, tall + 2 * gap):
        body -= Pos(0, 0, z) * Cylinder(pin / 2 + play, 2 * (pin_long - board) + 4)
    return body + knob(pin_x - 50, -door / 2, tall / 2)


def knob(x, y, z):
    stem = Pos(x, y, z) * Rot(90, 0, 0) * Pos(0, 0, -1) * Cylinder(8, 21, align=UP)
    return stem + Pos(x, y - 25, z) * Sphere(15)


def drawer_l(wide, deep, board, leg, divider, gap, door, side=12):
    """An open box behind a front that covers the edges of the case."""
    room, tall = (wide - 3 * board) / 2, divider - leg - board
    inside = Pos(board / 4, 0, 0)  # middle of the opening
    box = inside * Box(room - 2, deep - 30, tall - 2, align=BACK)
    box -= inside * Pos(0, 4, 10) * Box(room - 2 - 2 * side, deep - 34 - side, tall, align=BACK)
    front = Pos(0, -0.5, -board) * Box(wide / 2 - 2 * gap, door, tall + board - 5, align=FRONT)
    return box + inside * Pos(0, -1, 0) * Box(room - 2, 2, tall - 2, align=BACK) + front + knob(0, -door, tall / 2)
