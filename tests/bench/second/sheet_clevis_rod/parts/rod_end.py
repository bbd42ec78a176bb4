from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def rod_end(bore, reach=70, neck=10, neck_length=22, cross=4, cross_z=10, shank=14, eye=26, wide=14):
    rod = Cylinder(neck / 2, neck_length, align=LOW) + Pos(Z=neck_length) * Cylinder(shank / 2, reach - neck_length, align=LOW)
    rod -= Pos(Z=cross_z) * Rot(X=90) * Cylinder(cross / 2, 2 * neck)
    across = Pos(Z=reach) * Rot(Y=90)
    return rod + across * Cylinder(eye / 2, wide) - across * Cylinder(bore / 2, 2 * wide)
