from build123d import Align, Axis, Box, Cylinder, Pos, Rot, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)
ALONG_Y, ALONG_X = Rot(90, 0, 0), Rot(0, 90, 0)


def band(radius, band, deep, middle_z, sleeve, sleeve_low, arm_x, arm, arm_wide, arm_top, play):
    """Half ring over z = 0 with a blind sleeve below each end."""
    body = ALONG_Y * (Cylinder(radius, deep) - Cylinder(radius - band, 2 * deep))
    body -= Box(3 * radius, 2 * deep, 2 * radius, align=DOWN)
    for x in (-arm_x, arm_x):
        body += Pos(x, 0, 0) * Box(sleeve, deep, middle_z - sleeve_low, align=DOWN)
        body -= Pos(x, 0, arm_top + play - middle_z) * Box(arm + 2 * play, arm_wide + 2 * play, middle_z, align=DOWN)
    return body


def arm(arm, arm_wide, arm_top, arm_low, cup_z, fork, fork_top, slot, slot_top, pin, bore_play):
    body = Pos(0, 0, arm_low - cup_z) * (Box(arm, arm_wide, arm_top - arm_low, align=UP) + Box(arm, fork, fork_top - arm_low, align=UP))
    body -= Pos(0, 0, slot_top - cup_z) * Box(2 * arm, slot, cup_z, align=DOWN)
    return body - ALONG_Y * Cylinder(pin / 2 + bore_play, 2 * fork)


def cup(arm_x, cup, cup_out, cup_in, tongue, nose, pin, fork, ear=46, ear_deep=14):
    """A tongue with pins along y at the origin, behind it the cup towards +x; the ear's side is open."""
    near, far = arm_x - cup_out, arm_x - cup_in
    shell = Pos(near, 0, 0) * ALONG_X * Cylinder(cup / 2, far - near, align=UP)
    shell = fillet(shell.edges().sort_by(Axis.X)[-1], 5)
    shell -= Pos(far, 0, 0) * ALONG_X * Cylinder(ear / 2, ear_deep, align=DOWN)
    stem = Pos(near / 2, 0, 0) * Box(near + 2, tongue, 8.8) + ALONG_Y * Cylinder(nose, tongue)
    return shell + stem + ALONG_Y * Cylinder(pin / 2, fork - 2)
