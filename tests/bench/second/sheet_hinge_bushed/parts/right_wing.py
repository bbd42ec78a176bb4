from build123d import Align, Circle, Cylinder, Pos, Rectangle, Rot, extrude

HOLES = ((-26, 66), (-26, 18), (-56, 40))
LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def right_wing(wide, high, sheet, knuckle, room, head_deep, head, screw, low, middle, bush):
    outer = -knuckle / 2
    bar = Pos(0, outer) * Rectangle(wide, sheet, align=(Align.MAX, Align.MIN))
    leaf = Pos(-room / 2, outer) * Rectangle(wide - room / 2, sheet, align=(Align.MAX, Align.MIN))
    eye = Pos(Z=low) * extrude(Circle(knuckle / 2) + bar, middle)
    wing = extrude(leaf, high) + eye - Cylinder(bush / 2, high, align=LOW)
    for x, z in HOLES:
        inwards = Pos(x, outer, z) * Rot(X=-90)
        wing -= inwards * Cylinder(screw / 2, sheet, align=LOW)
        wing -= inwards * Pos(Z=sheet - head_deep) * Cylinder(head / 2, sheet, align=LOW)
    return wing
