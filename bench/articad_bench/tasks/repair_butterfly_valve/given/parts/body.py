from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    outside, bore, length, neck, neck_top = d["outside"], d["bore"], d["length"], d["neck"], d["neck_top"]
    shaft_hole, below = d["shaft_hole"], d["below"]
    shape = Rot(Y=90) * Cylinder(outside / 2, length) + Cylinder(neck / 2, neck_top, align=LOW)
    shape -= Rot(Y=90) * Cylinder(bore / 2, 2 * length)
    shape -= Pos(0, 0, -below) * Cylinder(shaft_hole / 2, 4 * below, align=LOW)
    return shape, {"shaft": {"o": (0, 0, neck_top), "z": (0, 0, 1), "x": (1, 0, 0)}}
