from build123d import Align, Axis, Box, Cylinder, Pos, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def rink(field, long=620, wide=320, high=35, rim=10, goal=120):
    """A tray with a goal in the middle of each end; the corners of its field are rounded."""
    room = Pos(0, 0, field) * Box(long - 2 * rim, wide - 2 * rim, high, align=UP)
    room = fillet(room.edges().filter_by(Axis.Z), 6)
    return Box(long, wide, high, align=UP) - room - Pos(0, 0, field) * Box(2 * long, goal, high, align=UP)


def puck(across=50, high=8):
    return Cylinder(across / 2, high, align=UP)


def mallet(across=64, high=40, foot=10, grip_d=26):
    body = Cylinder(across / 2, foot, align=UP) + Cylinder(grip_d / 2, high, align=UP)
    return fillet(body.edges().group_by(Axis.Z)[-1], 3)
