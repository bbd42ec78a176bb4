from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def clamp_screw(thread, tip=7, tip_long=5, long=44, head=28, head_high=12, cross=6):
    seat = tip_long + long
    screw = Cylinder(tip / 2, tip_long, align=LOW) + Pos(Z=tip_long) * Cylinder(thread / 2, long, align=LOW)
    screw += Pos(Z=seat) * Cylinder(head / 2, head_high, align=LOW)
    return screw - Pos(Z=seat + head_high / 2) * Rot(X=90) * Cylinder(cross / 2, 2 * head)
