from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
RIGHT = Rot(Y=90)  # turns z into x


def stile(hand, bar, deep, tall, first, pitch, blade_count):
    body = Pos(hand * bar / 2, 0, 0) * Box(bar, deep, tall, align=LOW)
    for number in range(blade_count):
        body -= Pos(hand * 12.5, 0, first + number * pitch) * RIGHT * Cylinder(7, 25)
    return body


def rail(inner, deep, bar):
    return Box(inner, deep, bar, align=LOW)


def blade(long, blade, thick, swell, pin):
    """A flat blade that swells about its pins."""
    body = Box(long, blade, thick) + RIGHT * Cylinder(swell / 2, long)
    for hand in (-1, 1):
        body -= Pos(hand * (long / 2 - 10), 0, 0) * RIGHT * Cylinder(pin / 2, 20)
    return body


def pin_left(pin, long):
    return RIGHT * Cylinder(pin / 2, long)


pin_right = pin_left


def bush_left(hand, pin, outer, flange, long):
    """Its flange lies on the inner face of the stile, where its frame is."""
    body = Cylinder(flange / 2, 2, align=LOW) + Pos(0, 0, 2 - long) * Cylinder(outer / 2, long - 2, align=LOW)
    return Rot(Y=-90 * hand) * (body - Cylinder(pin / 2 + 0.1, 3 * long))


bush_right = bush_left
