from build123d import Align, Circle, Cylinder, Pos, Rot, extrude

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def spacer(tail, outer=26, long=18, cross=4.2, cross_z=6):
    return extrude(Circle(outer / 2) - Circle(tail / 2), long) - Pos(Z=cross_z) * Rot(Y=90) * Cylinder(cross / 2, outer, align=LOW)
