from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
RIGHT, BACK = Rot(Y=90), Rot(X=-90)  # turn z into x, and into y


def base(long, deep, thick):
    return Box(long, deep, thick, align=LOW)


rail_low = rail_high = base


def side_left(thick, deep, high):
    return Box(thick, deep, high, align=LOW)


side_right = side_left


def bracket_low(wide, deep, pin, up):
    """A fork that stands on its rail, with a pin through both cheeks at its frame."""
    body = Pos(0, 0, -up) * Box(wide, deep, 5, align=LOW)
    for x in (-1, 1):
        body += Pos(x * (wide / 2 - 5), 0, -up) * Box(10, deep, up + 12, align=LOW)
    return body - RIGHT * Cylinder(pin / 2, 2 * wide)


def pin_low(across, long):
    return RIGHT * Cylinder(across / 2, long)


def lever_low(long, thick, bore):
    """A square bar toward the player; its bore is 20 from its far end."""
    return Pos(0, 20 - long / 2, 0) * Box(thick, long, thick) - RIGHT * Cylinder(bore / 2, 4 * thick)


lever_high = lever_low


def stick_low(across, long):
    return BACK * Cylinder(across / 2, long, align=(Align.CENTER, Align.CENTER, Align.MAX))


stick_high = stick_low
