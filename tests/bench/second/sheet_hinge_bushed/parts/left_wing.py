from build123d import Align, Box, Circle, Cylinder, Pos, Rectangle, Rot, extrude

HOLES = ((-56, 25), (-56, 62), (-24, 10), (-24, 70))
LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def left_wing(wide, high, sheet, knuckle, room, head_deep, head, screw, end, pin):
    outer = -knuckle / 2
    outline = Circle(knuckle / 2) + Pos(0, outer) * Rectangle(wide, sheet, align=(Align.MAX, Align.MIN)) - Circle(pin / 2)
    wing = extrude(outline, high)
    wing -= Pos(-room / 2, 0, end) * Box(2 * wide, 2 * knuckle, high - 2 * end, align=(Align.MIN, Align.CENTER, Align.MIN))
    for x, z in HOLES:
        inwards = Pos(x, outer, z) * Rot(X=-90)
        wing -= inwards * Cylinder(screw / 2, sheet, align=LOW)
        wing -= inwards * Pos(Z=sheet - head_deep) * Cylinder(head / 2, sheet, align=LOW)
    return wing
