from build123d import Align, Axis, Cylinder, Pos, fillet


def foot(thick, across=190, tenon_d=14, tenon=10):
    disc = Cylinder(across / 2, thick, align=(Align.CENTER, Align.CENTER, Align.MIN))
    disc = fillet(disc.edges().sort_by(Axis.Z)[-1], 4)
    return disc - Pos(0, 0, thick - tenon) * Cylinder(tenon_d / 2, tenon, align=(Align.CENTER, Align.CENTER, Align.MIN))
