from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)
RIGHT = Rot(Y=90)  # turns z into x


def rail(long, deep, high, pitch):
    """A bar with a hole for each tray."""
    body = Box(long, deep, high, align=LOW)
    for number in range(10):
        body -= Pos((number - 4.5) * pitch, 0, 0) * Cylinder(3, 4 * high)
    return body


def tray(wide, long, high, rails):
    body = Box(wide, long, high, align=LOW) - Pos(0, 0, 4) * Box(wide - 8, 2 * long, high, align=LOW)
    for y in (-1, 1):
        body -= Pos(0, y * rails / 2, 0) * Cylinder(3, 40)
    return body


def post(thick, high, bore):
    """Its bore is 25 below its top."""
    return Box(thick, thick, high, align=LOW) - Pos(0, 0, high - 25) * RIGHT * Cylinder(bore / 2, 2 * thick)


def jaw(long, inner, thick, bore):
    """Two arms beside the post, joined by a bar at their far end, which has a hole for the knob."""
    body = Pos(0, long - 5, 0) * Box(inner + 2 * thick, 20, 20)
    for x in (-1, 1):
        side = x * (inner + thick) / 2
        body += Pos(side, long / 2, 0) * Box(thick, long, 20) + Pos(side, 0, 0) * RIGHT * Cylinder(15, thick)
    return body - RIGHT * Cylinder(bore / 2, 4 * inner) - Pos(0, long - 5, 10) * Cylinder(4, 15, align=HIGH)


def bolt(shank, long, head):
    """Its frame is where the shank leaves the head."""
    return RIGHT * (Cylinder(shank / 2, long, align=LOW) + Cylinder(head / 2, 7, align=HIGH))


def nut(outer, bore, thick):
    return RIGHT * (Cylinder(outer / 2, thick, align=LOW) - Cylinder(bore / 2, 4 * thick))


def knob(across, stem, long):
    return Cylinder(across / 2, 25, align=LOW) + Cylinder(stem / 2, long, align=HIGH)


def screw_a(head, shank, long):
    return Cylinder(head / 2, 4, align=LOW) + Cylinder(shank / 2, long, align=HIGH)


screw_b = screw_a
