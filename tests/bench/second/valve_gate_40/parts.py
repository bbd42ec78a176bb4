from build123d import Align, Axis, Box, Cylinder, Pos, Rot, chamfer

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def body(long, wide, high, bore, bore_z, gate_long, gate_wide, gate_low, air):
    """A block with the bore along x and the gate's chamber, which is open above."""
    solid = Box(long, wide, high, align=UP) - Pos(0, 0, bore_z) * Rot(0, 90, 0) * Cylinder(bore / 2, 2 * long)
    return solid - Pos(0, 0, gate_low - air) * Box(gate_long + 2 * air, gate_wide + 2 * air, high, align=UP)


def gate(gate_long, gate_wide, gate_low, gate_top, thread, stem_low, lift, air):
    """A plate with parallel faces, bored from above for the stem's thread."""
    solid = Box(gate_long, gate_wide, gate_top - gate_low, align=UP)
    return solid - Pos(0, 0, stem_low - lift - 0.5 - gate_low) * Cylinder(thread / 2 + air / 2, gate_top, align=UP)


def stem(high, air, thread, stem, stem_low, stem_top, collar, collar_high):
    """Its origin is below the collar."""
    solid = Cylinder(collar / 2, collar_high, align=UP) + Cylinder(stem / 2, stem_top - high - air, align=UP)
    solid = chamfer(solid.edges().sort_by(Axis.Z)[-1], 1)
    return solid + Pos(0, 0, 1) * Cylinder(thread / 2, high + air - stem_low + 1, align=DOWN)


def bonnet(long, wide, bonnet, stem, collar, recess, air):
    solid = Box(long, wide, bonnet, align=UP) - Cylinder(collar / 2 + air, 2 * recess)
    return solid - Cylinder(stem / 2 + air / 2, 3 * bonnet)


def handwheel(wheel, rim, wheel_high, hub, spoke, stem):
    solid = Cylinder(wheel / 2, wheel_high, align=UP) - Cylinder(wheel / 2 - rim, 3 * wheel_high)
    solid += Cylinder(hub / 2, wheel_high, align=UP)
    for turn in (0, 120, 240):
        solid += Rot(0, 0, turn) * Pos(wheel / 4, 0, 1.5) * Box(wheel / 2 - rim, spoke, wheel_high - 3, align=UP)
    return solid - Cylinder(stem / 2, 3 * wheel_high)
