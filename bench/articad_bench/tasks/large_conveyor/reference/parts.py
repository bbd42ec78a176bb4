from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
ALONG = Rot(X=-90)  # turns z into y


def rail(length, high, plate, pitch, axle, hand, flange, rollers_count):
    """A channel whose web stands beside the rollers; its flanges point away from them."""
    web = Pos(0, hand * plate / 2, 0) * Box(length, plate, high)
    for z in (-1, 1):
        web += Pos(0, hand * flange / 2, z * (high - plate) / 2) * Box(length, flange, plate)
    for number in range(rollers_count):
        web -= Pos((number - (rollers_count - 1) / 2) * pitch, 0, 0) * ALONG * Cylinder(axle / 2 + 0.1, 4 * plate)
    return web


def axle(axle, reach):
    rod = ALONG * Cylinder(axle / 2, reach)
    for hand in (-1, 1):
        rod -= Pos(0, hand * (reach / 2 - 12.5), 0) * ALONG * Cylinder(4, 25)
    return rod


def roller(tube, long, axle):
    """A tube with a closed end at each side, in which a seat for a bearing is turned."""
    body = ALONG * Cylinder(tube / 2, long) - ALONG * Cylinder(tube / 2 - 3, long - 32) - ALONG * Cylinder(axle / 2 + 4, 2 * long)
    for hand in (-1, 1):
        body -= Pos(0, hand * (long / 2 - 4.5), 0) * ALONG * Cylinder(14.1, 9)
    return body


def bearing_left(outer, bore, wide):
    return ALONG * (Cylinder(outer / 2, wide) - Cylinder(bore / 2, 2 * wide))


bearing_right = bearing_left


def screw_left(hand, shank, long, head, high):
    return Rot(X=-90 * hand) * (Cylinder(head / 2, high, align=LOW) + Pos(0, 0, -long) * Cylinder(shank / 2, long, align=LOW))


screw_right = screw_left


def leg(wide, across, tall):
    return Box(wide, across, tall, align=LOW) - Box(wide - 6, across - 6, 2 * tall) + Box(wide, across, 6, align=LOW) - Cylinder(8, 20)


def foot(disc, stem, tall, into):
    return Cylinder(disc / 2, 10, align=LOW) + Cylinder(disc / 4, tall, align=LOW) + Cylinder(stem / 2, tall + into, align=LOW)


def tie(wide, across, reach):
    return Box(wide, reach, across) - Box(wide - 6, 2 * reach, across - 6)
