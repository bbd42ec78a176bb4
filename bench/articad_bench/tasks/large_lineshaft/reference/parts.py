from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)
RIGHT = Rot(Y=90)  # turns z into x


def bench(long, deep, thick):
    return Box(long, deep, thick, align=LOW)


def beam(long, deep, high):
    return Box(long, deep, high, align=LOW)


def post(wide, high):
    return Box(wide, wide, high, align=LOW)


leg = post


def shaft(shaft, long, pitch):
    """A round shaft with a keyway on top for each pulley."""
    body = RIGHT * Cylinder(shaft / 2, long)
    for number in range(-2, 3):
        body -= Pos(number * pitch, 0, 15) * Box(50, 12, shaft, align=LOW)
    return body


def hanger(bore, drop):
    body = Pos(0, 0, drop) * Box(160, 120, 20, align=HIGH) + Pos(0, 0, drop) * Box(40, 60, drop, align=HIGH)
    return body + RIGHT * Cylinder(bore / 2 + 15, 40) - RIGHT * Cylinder(bore / 2, 80)


def pedestal_a(bore, drop):
    body = Pos(0, 0, -drop) * Box(60, 140, 16, align=LOW) + Pos(0, 0, -drop) * Box(30, 60, drop, align=LOW)
    return body + RIGHT * Cylinder(bore / 2 + 12, 30) - RIGHT * Cylinder(bore / 2, 80)


pedestal_b = pedestal_a


def bearing_a(outer, bore, wide):
    return RIGHT * (Cylinder(outer / 2, wide) - Cylinder(bore / 2, 2 * wide))


bearing_b = main_bearing = collar = bearing_a


def key(long, wide, high):
    return Box(long, wide, high, align=LOW)


def countershaft(counter, long):
    return RIGHT * Cylinder(counter / 2, long)


def driven(across, face, bore):
    return RIGHT * (Cylinder(across / 2, face) - Cylinder(bore / 2, 2 * face))


work = driven


def pulley(across, face, bore):
    return driven(across, face, bore) - Pos(0, 0, 0) * Box(2 * face, 12, 23, align=LOW)
