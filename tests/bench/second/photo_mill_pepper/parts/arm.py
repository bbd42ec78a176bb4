from build123d import Align, Circle, Cylinder, Pos, Rectangle, extrude

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def arm(reach, plate, washer, stud, stud_long, pin, wide=14, ring=9):
    outline = Circle(wide / 2) + Pos(0, reach) * Circle(wide / 2) + Rectangle(wide, reach, align=(Align.CENTER, Align.MIN))
    lever = extrude(outline, plate) + Cylinder(wide / 2, stud_long, align=LOW) + Pos(Y=reach) * Cylinder(ring / 2, plate + washer, align=LOW)
    lever -= Cylinder(stud / 2, stud_long, align=LOW)
    return lever - Pos(Y=reach) * Cylinder(pin / 2, plate + washer, align=LOW)
