from build123d import Align, Axis, Cylinder, Pos, Rot, chamfer

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def core(across, outer, flange, core_high, jaw_d, jaw_long, play, lean, tip_r, tip_z, spindle_d=12, spindle_deep=9):
    """About z with a flange below the sleeve, three leaning bores from above and a tapping hole from below."""
    body = Cylinder(across / 2, core_high, align=UP) + Cylinder(outer / 2, flange, align=UP)
    body = chamfer(body.edges().group_by(Axis.Z)[0], 0.6)
    for turn in (0, 120, 240):
        tip = Rot(0, 0, turn) * Pos(tip_r, 0, tip_z) * Rot(0, -lean, 0)
        body -= tip * Pos(0, 0, 40) * Cylinder(jaw_d / 2 + play, jaw_long + 41, align=DOWN)
    return body - Cylinder(spindle_d / 2, spindle_deep, align=UP)


def sleeve(across, outer, sleeve_high, play):
    ring = Cylinder(outer / 2, sleeve_high, align=UP)
    ring = chamfer(ring.edges().group_by(Axis.Z)[-1], 0.6)
    return ring - Cylinder(across / 2 + play, 3 * sleeve_high)


def jaw(jaw_d, jaw_long):
    return Cylinder(jaw_d / 2, jaw_long, align=DOWN)
