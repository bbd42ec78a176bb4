from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)
RIGHT, BACK = Rot(Y=90), Rot(X=-90)  # turn z into x, and into y


def runway_left(long, wide, high):
    return Box(long, wide, high, align=LOW)


runway_right = rail = stop_left = stop_right = runway_left


def column(wide, long, high):
    return Box(wide, long, high, align=LOW)


girder = track = tie = column


def truck(hand, long, wide, high, axle, drop):
    """A box with a pocket for a wheel at each end, nearer to the inside, where the flanges are."""
    body = Box(long, wide, high, align=LOW)
    for x in (-500, 500):
        body -= Pos(x, -5 * hand, 0) * Box(170, 64, 4 * high) + Pos(x, 0, drop) * BACK * Cylinder(axle / 2, 2 * wide)
    return body


def buffer_left(across, long):
    return RIGHT * Cylinder(across / 2, long)


buffer_right = buffer_left


def flanged(hand, across, tread, flange, bore):
    """A wheel about z whose flange is beside the tread, on the side of hand."""
    body = Cylinder(across / 2, tread) + Pos(0, 0, hand * (tread / 2 + 5)) * Cylinder(flange / 2, 10)
    return body - Cylinder(bore / 2, 4 * tread)


def wheel_left(hand, across, tread, flange, bore):
    return BACK * flanged(hand, across, tread, flange, bore)


wheel_right = wheel_left


def runner_1(hand, across, tread, flange, bore):
    return RIGHT * flanged(hand, across, tread, flange, bore)


runner_2 = runner_1


def axle_left(across, long):
    return BACK * Cylinder(across / 2, long)


axle_right = axle_left


def pin_1(across, long):
    return RIGHT * Cylinder(across / 2, long)


pin_2 = pin_1


def trolley(long, wide, high, thin, drop):
    body = Box(long, wide, high, align=LOW) - Box(84, 84, 4 * high)
    for x in (-250, 250):
        inner = 5 if x < 0 else -5
        for y in (-200, 200):
            body -= Pos(x + inner, y, 0) * Box(46, 130, 4 * high) + Pos(x, y, drop) * RIGHT * Cylinder(thin / 2, 80)
    return body


def sleeve(outer, inner, high):
    return Box(outer, outer, high, align=LOW) - Box(inner, inner, 4 * high)


def mast(wide, long):
    return Box(wide, wide, long, align=LOW) - Cylinder(15.1, 51, align=LOW)


def hook(stem, deep, body):
    """A stem in the mast, a plate below it, and an eye in the plate."""
    plate = Pos(0, 0, -1) * Box(body, 20, 2 * body, align=HIGH) - Pos(0, 0, -1.5 * body) * BACK * Cylinder(body / 3, 80)
    return plate + Pos(0, 0, -1) * Cylinder(stem / 2, deep + 1, align=LOW)
