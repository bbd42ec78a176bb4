from build123d import Align, Cylinder, Pos, Sphere

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def screw(spindle_d, ball_d, neck_d, shank, tang_d, tang, neck=13):
    rod = Sphere(ball_d / 2) + Cylinder(neck_d / 2, neck + 1, align=UP)
    rod += Pos(0, 0, neck) * Cylinder(spindle_d / 2, shank - neck, align=UP)
    return rod + Pos(0, 0, shank) * Cylinder(tang_d / 2, tang, align=UP)
