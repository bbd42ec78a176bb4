from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.MIN, Align.CENTER, Align.MIN)
UP = (Align.CENTER, Align.CENTER, Align.MIN)
X, Y = Rot(Y=90), Rot(X=90)


def body(long, wide, high, port_d, port_z, seat_x, room_long, room_wide, room_low, pin_x, pin_z, pin_d):
    block = Box(long, wide, high) - Pos(seat_x, 0, room_low) * Box(room_long, room_wide, high, align=LOW)
    block -= Pos(0, 0, port_z) * X * Cylinder(port_d / 2, 2 * long)
    return block - Pos(pin_x, 0, pin_z) * Y * Cylinder(pin_d / 2, 2 * wide)


def flap(port_z, pin_z, pin_x, seat_x, pin_d, play, flap_d, flap_thick, seat_gap, eye_d=13, eye=18, arm=14):
    """Disc below the pin with an arm and an eye; shut, its face is at the seat."""
    face, down = seat_x + seat_gap - pin_x, port_z - pin_z
    disc = Pos(face, 0, down) * X * Cylinder(flap_d / 2, flap_thick, align=UP)
    disc += Pos(face, 0, down) * Box(flap_thick, arm, -down, align=LOW) + Y * Cylinder(eye_d / 2, eye)
    return disc - Y * Cylinder(pin_d / 2 + play, 2 * eye)


def pin(pin_d, wide):
    return Cylinder(pin_d / 2, wide)


def cover(long, wide, cover, seat_x, room_long, room_wide, spigot=4, free=0.2):
    plate = Box(long, wide, cover, align=UP)
    return plate + Pos(seat_x + room_long / 2, 0, -spigot) * Box(room_long - 2 * free, room_wide - 2 * free, spigot + 1, align=UP)
