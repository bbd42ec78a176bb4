from build123d import Align, Box, Cylinder, Pos, RegularPolygon, Rot, chamfer, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)
FORE = (Align.CENTER, Align.MIN, Align.CENTER)
AFT = (Align.CENTER, Align.MAX, Align.CENTER)


def half(shaft, across, wide, slit, screw, apart, side):
    ring = Cylinder(across / 2, wide)
    ring = chamfer(ring.edges(), 0.6) - Cylinder(shaft / 2, 2 * wide)
    ring &= Pos(0, side * slit / 2, 0) * Box(2 * across, across, 2 * wide, align=FORE if side > 0 else AFT)
    for x in (-apart / 2, apart / 2):
        ring -= Pos(x, 0, 0) * Rot(90, 0, 0) * Cylinder(screw / 2, 2 * across)
    return ring


def rear(shaft, across, wide, slit, screw, apart):
    return half(shaft, across, wide, slit, screw, apart, -1)


def front(shaft, across, wide, slit, screw, apart, seat, sink):
    body = half(shaft, across, wide, slit, screw, apart, 1)
    for x in (-apart / 2, apart / 2):
        body -= Pos(x, seat, 0) * Rot(-90, 0, 0) * Cylinder(sink / 2, across, align=UP)
    return body


def shaft(shaft, shaft_long):
    body = Cylinder(shaft / 2, shaft_long, align=UP)
    return chamfer(body.edges(), 1)


def screw(screw, head, head_high, seat, tip, socket=4):
    """Head on z = 0 upwards, shank below."""
    body = Cylinder(head / 2, head_high, align=UP) + Cylinder(screw / 2, seat - tip, align=(Align.CENTER, Align.CENTER, Align.MAX))
    return body - Pos(0, 0, head_high / 2) * extrude(RegularPolygon(socket / 2, 6, major_radius=False), head_high)
