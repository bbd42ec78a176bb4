from build123d import Align, Box, Cylinder, Pos, Rot

MIN_X = (Align.MIN, Align.CENTER, Align.CENTER)
UP = (Align.CENTER, Align.CENTER, Align.MIN)
X, Y = Rot(0, 90, 0), Rot(90, 0, 0)


def foot(pin_x, pin_d, slot, ear, plate=8, wide=50, tall=60, high=24):
    """Plate with two ears; the cross pin is riveted in them."""
    body = Pos(-pin_x, 0, 0) * Box(plate, wide, tall, align=MIN_X)
    for side in (-1, 1):
        y = side * (slot + ear) / 2
        body += Pos(-pin_x, y, 0) * Box(pin_x, ear, high, align=MIN_X) + Pos(0, y, 0) * Y * Cylinder(high / 2, ear)
    return body + Y * Cylinder(pin_d / 2, slot + 2 * ear)


def tube(pin_d, play, slot, tube_d, tube_x, tube_long, bore_d, rod_d, slack, end, front=10, eye=22):
    """Closed tube along x with a tongue; the origin is the pin."""
    body = Pos(tube_x, 0, 0) * X * Cylinder(tube_d / 2, tube_long, align=UP)
    tongue = slot - 0.6
    body += Box(tube_x + 1, tongue, eye, align=MIN_X) + Y * Cylinder(eye / 2, tongue)
    body -= Y * Cylinder(pin_d / 2 + play, 2 * slot)
    body -= Pos(tube_x + end, 0, 0) * X * Cylinder(bore_d / 2, tube_long - end - front, align=UP)
    return body - Pos(tube_x + tube_long / 2, 0, 0) * X * Cylinder(rod_d / 2 + slack, tube_long, align=UP)


def piston_rod(bore_d, slack, rod_d, pin_x, tube_x, tube_long, end, clevis_x, spigot, stroke, front=10, rest=0.5):
    """Piston at the origin, just before the tube's closed end."""
    room = tube_long - end - front
    body = Pos(rest, 0, 0) * X * Cylinder(bore_d / 2 - slack, room - stroke - 2 * rest, align=UP)
    return body + Pos(rest + 1, 0, 0) * X * Cylinder(rod_d / 2, clevis_x + spigot - pin_x - tube_x - end - rest - 1, align=UP)


def fork(rod_d, clevis_long, spigot, side=24, gap=12, gap_deep=24, hole=10):
    """Square fork from x = 0; its slot is open to z, its hole lies along y."""
    body = Box(clevis_long, side, side, align=MIN_X)
    body -= Pos(clevis_long - gap_deep, 0, 0) * Box(gap_deep + 1, gap, 2 * side, align=MIN_X)
    body -= X * Cylinder(rod_d / 2, spigot, align=UP)
    return body - Pos(clevis_long - 12, 0, 0) * Y * Cylinder(hole / 2, 2 * side)
