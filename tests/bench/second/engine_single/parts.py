from build123d import Align, Axis, Box, Circle, Cylinder, Pos, Rectangle, Rot, chamfer, extrude, make_hull

UP = (Align.CENTER, Align.CENTER, Align.MIN)
BACK = Rot(-90, 0, 0)


def along_y(radius, low, high, x=0, z=0):
    return Pos(x, low, z) * BACK * Cylinder(radius, high - low, align=UP)


def frame(axis_z, bore, play, shaft_d, plate_y, plate, base=12, wide=130, front=-40, back=64, low=138, tall=234, wall=5, cut=-8):
    """Base, upright with the bearing, cylinder with its front cut off."""
    body = Pos(0, (front + back) / 2, 0) * Box(wide, back - front, base, align=UP)
    body = chamfer(body.edges().filter_by(Axis.Z), 6)
    body += Pos(0, plate_y + plate / 2, 0) * Box(bore + 2 * wall, plate, tall, align=UP)
    body += Pos(0, 0, low) * Cylinder(bore / 2 + wall, tall - low, align=UP)
    body -= Pos(0, 0, low - 1) * Cylinder(bore / 2, tall, align=UP)
    body -= Pos(0, cut, low - 1) * Box(4 * bore, 4 * bore, tall, align=(Align.CENTER, Align.MAX, Align.MIN))
    return body - along_y(shaft_d / 2 + play, 0, 3 * plate_y, z=axis_z)


def crankshaft(throw, shaft_d, pin_d, rod_thick, air, plate_y, plate, wheel):
    """Its crank pin lies on z."""
    web = make_hull((Circle(14) + Pos(0, throw) * Circle(11)).edges())
    body = Pos(0, plate_y - air, 0) * Rot(90, 0, 0) * extrude(web, plate_y - 2 * air - rod_thick / 2)
    body += along_y(shaft_d / 2, plate_y - 2 * air, plate_y + plate + air + wheel)
    return body + along_y(pin_d / 2, -rod_thick / 2 - 2, rod_thick, z=throw)


def flywheel(wheel_d, wheel, shaft_d, rim=12):
    """From y = 0 to the back."""
    disc = along_y(wheel_d / 2, 0, wheel)
    for low, high in ((-1, 4), (wheel - 4, wheel + 1)):
        disc -= along_y(wheel_d / 2 - rim, low, high) - along_y(14, low - 1, high + 1)
    return disc - along_y(shaft_d / 2, -1, wheel + 1)


def rod(rod_long, rod_thick, pin_d, gudgeon_d, play, big=11, small=8, shank=9):
    """From the crank pin at the origin up along z."""
    flat = Circle(big) + Pos(0, rod_long) * Circle(small) + Pos(0, rod_long / 2) * Rectangle(shank, rod_long)
    flat -= Circle(pin_d / 2 + play) + Pos(0, rod_long) * Circle(gudgeon_d / 2 + play)
    return Rot(90, 0, 0) * extrude(flat, rod_thick / 2, both=True)


def piston(bore, play, gudgeon_d, rod_thick, crown=18, skirt=14, gap=0.5):
    """About its gudgeon pin, open below for the rod."""
    body = Pos(0, 0, -skirt) * Cylinder(bore / 2 - play, skirt + crown, align=UP)
    body -= Pos(0, 0, 10) * Box(28, rod_thick + 2 * gap, 4 * skirt, align=(Align.CENTER, Align.CENTER, Align.MAX))
    return body - along_y(gudgeon_d / 2, -bore, bore)


def gudgeon(gudgeon_d, bore, short=3):
    return along_y(gudgeon_d / 2, short - bore / 2, bore / 2 - short)
