from build123d import Align, Box, Cylinder, Pos, Rot

CORNER = (Align.MIN, Align.MIN, Align.MIN)
MIDDLE = (Align.CENTER, Align.MIN, Align.MIN)
LOW = (Align.CENTER, Align.CENTER, Align.MIN)
BACK = Rot(X=-90)  # turns z into y


def bottom(across, depth, board):
    return Box(across, depth, board, align=CORNER)


top = bottom


def side_left(board, depth, tall):
    return Pos(Z=board) * Box(board, depth, tall - 2 * board, align=CORNER)


side_right = side_left


def divider(board, depth, tall):
    return Box(board, depth, tall - 2 * board, align=CORNER)


def back(across, tall, thick):
    return Box(across, thick, tall, align=CORNER)


def shelf(cell_w, depth, board):
    return Box(cell_w, depth, board, align=CORNER)


def box(wide, deep, high, wall, cell_h="cell_h"):
    """An open box; its back is 30 lower than its front, and two holes for screws go through its front."""
    body = Box(wide, deep, high, align=MIDDLE)
    body -= Pos(0, wall, wall) * Box(wide - 2 * wall, deep - 2 * wall, high, align=MIDDLE)
    body -= Pos(0, deep - wall, high - 30) * Box(wide - 2 * wall, 2 * wall, high, align=MIDDLE)
    for x in (-120, 120):
        body -= Pos(x, 0, cell_h / 2 - 0.5) * BACK * Cylinder(2.3, 4 * wall)
    return body


def face(face_w, face_h, front, hole):
    panel = Box(face_w, front, face_h, align=MIDDLE)
    panel -= Pos(0, 0, face_h / 2) * BACK * Cylinder(hole / 2, 16.5, align=LOW)
    for x in (-120, 120):
        panel -= Pos(x, front, face_h / 2) * BACK * Cylinder(2, 25)
    return panel


def knob(head, stem, into):
    return Pos(0, into, 0) * BACK * Cylinder(stem / 2, into + 6, align=(Align.CENTER, Align.CENTER, Align.MAX)) + Pos(0, -20, 0) * BACK * Cylinder(head / 2, 15, align=LOW)


def screw_a(shank, long, head):
    return Pos(0, -long + 0, 0) * BACK * Cylinder(shank / 2, long, align=LOW) + BACK * Cylinder(head / 2, 3, align=LOW)
