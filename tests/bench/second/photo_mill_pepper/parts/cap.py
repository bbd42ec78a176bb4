from build123d import Align, Cylinder

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def cap(disc, stem, stem_long, stud, stud_long, wide=44):
    return Cylinder(wide / 2, disc, align=LOW) + Cylinder(stem / 2, stem_long, align=HIGH) + Cylinder(stud / 2, disc + stud_long, align=LOW)
