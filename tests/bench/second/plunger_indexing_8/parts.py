from build123d import Align, Axis, Cylinder, Pos, chamfer, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def sleeve(barrel_d, barrel, collar_d, collar, pin_d, play, stem_d, sole, shoulder, lift, rest, room_d):
    body = Cylinder(barrel_d / 2, barrel, align=UP) + Pos(Z=barrel) * Cylinder(collar_d / 2, collar, align=UP)
    body -= Cylinder(pin_d / 2 + play, 2 * sole) + Pos(Z=sole) * Cylinder(room_d / 2, shoulder + lift + 2 * rest, align=UP)
    return body - Pos(Z=sole) * Cylinder(stem_d / 2 + play, 2 * barrel, align=UP)


def plunger(pin_d, out, sole, rest, shoulder_d, shoulder, stem_d, knob_z, socket=12):
    """From its lower end: pin, shoulder, stem."""
    low = out + sole + rest
    pin = chamfer(Cylinder(pin_d / 2, low + 1, align=UP).edges().sort_by(Axis.Z)[0], 1)
    return pin + Pos(Z=low) * Cylinder(shoulder_d / 2, shoulder, align=UP) + Pos(Z=low) * Cylinder(stem_d / 2, out + knob_z + socket - low, align=UP)


def knob(stem_d, across=25, high=20, socket=12):
    body = Cylinder(across / 2, high, align=UP)
    body = fillet(body.edges(), 3)
    return body - Cylinder(stem_d / 2, socket, align=UP)
