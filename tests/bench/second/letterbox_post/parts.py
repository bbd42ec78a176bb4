from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.MIN, Align.MIN, Align.MIN)
UP = (Align.CENTER, Align.CENTER, Align.MIN)
X = Rot(Y=90)


def block(x, y, z):
    """Return a box between two values of each coordinate."""
    return Pos(x[0], y[0], z[0]) * Box(x[1] - x[0], y[1] - y[0], z[1] - z[0], align=LOW)


def lengthwise(d, x, y, z):
    """A cylinder along x, between two values of x."""
    return Pos((x[0] + x[1]) / 2, y, z) * X * Cylinder(d / 2, x[1] - x[0])


def sides(low, wide):
    return ((-low - wide, -low), (low, low + wide))


def post(box_z, side=60):
    return Box(side, side, box_z, align=UP)


def box(wide, high, deep, wall, box_z, eye_d, lid_y, lid_z, rod_d, play, ear_x, ear, door_y, door_z, door_eye, door_rod, door_high, flag_y, flag_z, flag_pin, flag_gap, flag_thick, out):
    """Open above and, behind the door, in front; with the eyes of both hinges and the stud of the flag."""
    half, back, low = wide / 2, deep / 2, door_z - box_z
    body = block((-half, half), (-back, back), (0, high)) - block((wall - half, half - wall), (wall - back, back - wall), (wall, 2 * high))
    body -= block((15 - half, half - 15), (-deep, 0), (low + 12, low + door_high - 8))
    for x in sides(ear_x, ear):
        body += block(x, (back - 1, lid_y + eye_d / 2), (high - 30, lid_z - box_z)) + lengthwise(eye_d, x, lid_y, lid_z - box_z)
        body += block(x, (door_y, 1 - back), (low - 3, low + 3)) + lengthwise(door_eye, x, door_y, low)
    body -= lengthwise(rod_d + 2 * play, (-wide, wide), lid_y, lid_z - box_z)
    body -= lengthwise(door_rod + 2 * play, (-wide, wide), door_y, low)
    body += lengthwise(flag_pin, (half - wall, out), flag_y, flag_z - box_z)
    return body + lengthwise(flag_pin + 6, (half + 2 * flag_gap + flag_thick, out), flag_y, flag_z - box_z)


def lid(wide, deep, lid_low, lid_thick, lid_y, eye_d, rod_d, ear_x, ear, cut=9):
    """Shut, about the hinge: plate, knuckle between the eyes, rod through them."""
    low = lid_low
    body = block((-wide / 2, wide / 2), (-deep / 2 - lid_y, -cut), (low, low + lid_thick))
    body += block((0.5 - ear_x, ear_x - 0.5), (-cut - 1, 0), (low, low + lid_thick)) + lengthwise(eye_d, (0.5 - ear_x, ear_x - 0.5), 0, 0)
    return body + lengthwise(rod_d, (-ear_x - ear, ear_x + ear), 0, 0)


def door(wide, deep, door_y, door_high, door_eye, door_rod, ear_x, ear, front, thick=2, knob_d=14):
    """Shut, about the hinge: plate before the box, knuckle between the eyes, a knob above."""
    inner = -deep / 2 - 0.5 - door_y
    body = block((3 - wide / 2, wide / 2 - 3), (inner - thick, inner), (6, door_high))
    body += block((0.5 - ear_x, ear_x - 0.5), (inner - thick, inner), (0, 7)) + lengthwise(door_eye, (0.5 - ear_x, ear_x - 0.5), 0, 0)
    body += lengthwise(door_rod, (-ear_x - ear, ear_x + ear), 0, 0)
    end = -front - door_y
    return body + Pos(0, (end + inner - 1) / 2, door_high - 25) * Rot(X=90) * Cylinder(knob_d / 2, inner - 1 - end)


def flag(flag_pin, play, flag_gap, flag_thick, arm=100, wide=14, cloth=34, tall=40):
    """Lying towards +y about its pin."""
    x = (flag_gap, flag_gap + flag_thick)
    body = lengthwise(wide, x, 0, 0) + block(x, (0, arm), (-wide / 2, wide / 2)) + block(x, (arm - cloth, arm), (0, tall))
    return body - lengthwise(flag_pin + 2 * play, (-flag_thick, 3 * flag_thick), 0, 0)
