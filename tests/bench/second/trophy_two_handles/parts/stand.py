from build123d import Align, Cylinder

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def stand(plinth_d, plinth_high, stem_d, stem_long):
    return Cylinder(plinth_d / 2, plinth_high, align=UP) + Cylinder(stem_d / 2, plinth_high + stem_long, align=UP)
