from build123d import Align, Box, Circle, Cone, Cylinder, Helix, Plane, Pos, Rot, sweep

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)
LOW = (Align.MIN, Align.MIN, Align.MIN)
Y = Rot(X=90)


def block(x, y, z):
    """Return a box between two values of each coordinate."""
    return Pos(x[0], y[0], z[0]) * Box(x[1] - x[0], y[1] - y[0], z[1] - z[0], align=LOW)


def body(skirt_d, low_z, skirt_top, tube_d, tube_top, neck_d, neck_top, spindle_d, play, pivot_x, pivot_z, wing, pin_d, stay, stay_gap):
    """Skirt and tube; two stays on either side hold each wing's pin."""
    shape = Pos(Z=low_z) * Cylinder(skirt_d / 2, skirt_top - low_z, align=UP) + Pos(Z=low_z) * Cylinder(tube_d / 2, tube_top - low_z, align=UP)
    near, half = wing / 2 + stay_gap, pivot_x + 12.5
    for y in ((-near - stay, -near), (near, near + stay)):
        shape += block((-half, half), y, (82, 111))
    for x in (-pivot_x, pivot_x):
        shape += Pos(x, 0, pivot_z) * Y * Cylinder(pin_d / 2, 2 * near + 1)
    shape -= Pos(Z=low_z - 1) * Cylinder(neck_d / 2, neck_top - low_z + 1, align=UP)
    return shape - Pos(Z=low_z) * Cylinder(spindle_d / 2 + play, 150, align=UP)


def spindle(spindle_d, spindle_low, handle_z, stem_d, stem_play, gap=0.2, rack_low=26, pitch=4, deep=1.2):
    """Bored for the stem; the rack is turned, a row of grooves round the spindle."""
    long = handle_z - gap - spindle_low
    shape = Cylinder(spindle_d / 2, long, align=UP) - Cylinder(stem_d / 2 + stem_play, 3 * long)
    for k in range(14):
        shape -= Pos(Z=rack_low + k * pitch) * (Cylinder(spindle_d, pitch / 2, align=UP) - Cylinder(spindle_d / 2 - deep, pitch / 2, align=UP))
    return shape


def handle(handle_z, top, spindle_low, stem_d, grip=70, wide=13, worm=42, core_d=3.6, wire=2.4, worm_r=1.7):
    """Bar above the origin, the stem below; at its end a gimlet: a pointed core with a helical thread."""
    end = spindle_low - handle_z - 2
    shape = Box(grip, wide, top - handle_z, align=UP) + Cylinder(stem_d / 2, -end, align=DOWN)
    shape += Pos(Z=end - worm) * Cylinder(core_d / 2, worm + 1, align=UP) + Pos(Z=end - worm - 5) * Cone(0.2, core_d / 2, 5, align=UP)
    path = Helix(pitch=8, height=worm - 2, radius=worm_r, center=(0, 0, end - worm + 3))
    start = Plane(origin=path @ 0, z_dir=path % 0)
    return shape + sweep(start * Circle(wire / 2), path=path, is_frenet=True)


def wing(wing, head_d, pivot_z, pin_d, play, arm=12, bulb_r=9.2, offset=4.3):
    """Hanging from its pin, a bulb at the lower end; the outer side is -x."""
    shape = Y * Cylinder(head_d / 2, wing) + Pos(-offset, 0, bulb_r - pivot_z) * Y * Cylinder(bulb_r, wing)
    shape += block((-offset - arm / 2, -offset + arm / 2), (-wing / 2, wing / 2), (bulb_r - pivot_z, 0))
    return shape - Y * Cylinder(pin_d / 2 + play, 3 * wing)
