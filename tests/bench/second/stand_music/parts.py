from build123d import Align, Axis, Box, Cylinder, Plane, Pos, Rot, chamfer, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)
CORNER = (Align.MIN, Align.MIN, Align.MIN)
ALONG_X = Rot(Y=90)


def foot(leg, leg_wide, leg_low, leg_high, tube_low, tube_d, collar_low, collar_high, collar_d, rod_d, play, screw_z, screw_d, post=32):
    """A tube on three legs whose ends stand on the floor; at its top a collar for the clamp screw."""
    body = Pos(0, 0, tube_low) * Cylinder(tube_d / 2, collar_low - tube_low + 1, align=UP)
    collar = Pos(0, 0, collar_low) * Cylinder(collar_d / 2, collar_high - collar_low, align=UP)
    body += chamfer(collar.edges(), 1)
    for angle in (90, 210, 330):
        limb = Pos(0, 0, leg_low) * Box(leg, leg_wide, leg_high - leg_low, align=(Align.MIN, Align.CENTER, Align.MIN))
        limb += Pos(leg - post, 0, 0) * Box(post, leg_wide, leg_high, align=(Align.MIN, Align.CENTER, Align.MIN))
        body += Rot(Z=angle) * limb
    body -= Cylinder(rod_d / 2 + play, 3 * collar_high)
    return body - Pos(0, 0, screw_z) * ALONG_X * Cylinder(screw_d / 2 + 0.1, collar_d, align=UP)


def rod(rod_low, axis_z, rod_d, eye, lug_gap, lug, pivot_d):
    """Down from its eye at the origin; trunnions along x."""
    tail = Pos(0, 0, rod_low - axis_z) * Cylinder(rod_d / 2, axis_z - rod_low, align=UP)
    body = chamfer(tail.edges().sort_by(Axis.Z)[0], 1) + ALONG_X * Cylinder(eye, rod_d)
    return body + ALONG_X * Cylinder(pivot_d / 2, rod_d + 2 * lug_gap + 2 * lug)


def clamp_screw(collar_d, rod_d, screw_d, knob_d=24, knob=20, air=0.3):
    """Its tip lies against the rod, its knob outside the collar from x = 0 on."""
    tip = rod_d / 2 + 0.05 - collar_d / 2
    body = Pos(tip, 0, 0) * ALONG_X * Cylinder(screw_d / 2, 1 - tip, align=UP)
    grip = Pos(air, 0, 0) * ALONG_X * Cylinder(knob_d / 2, knob - air, align=UP)
    return body + fillet(grip.edges(), 1.5)


def desk(axis_z, low, high, desk_half, face_y, sheet, hinge_x, hinge_y, knuckle_r, pin_d, first_z, second_z, knuckle, pivot_d, eye, rod_d, lug_gap, lug, play, ledge_y=-58):
    """An upright sheet before the axis, a ledge in front, two lugs behind, and at either edge two knuckles with pins upwards."""
    body = Pos(-desk_half, face_y, low - axis_z) * Box(2 * desk_half, sheet, high - low, align=CORNER)
    body = fillet(body.edges().filter_by(Axis.Y).group_by(Axis.Z)[-1], 10)
    shelf = Pos(-desk_half, ledge_y, low - axis_z) * Box(2 * desk_half, face_y + 1 - ledge_y, sheet, align=CORNER)
    body += fillet(shelf.edges().filter_by(Axis.Z).group_by(Axis.Y)[0], 6)
    for side in (-1, 1):
        x = side * (rod_d / 2 + lug_gap + lug / 2)
        ear = Pos(x, 0, 0) * (ALONG_X * Cylinder(eye, lug) + Box(lug, -face_y - 1, 2 * eye, align=(Align.CENTER, Align.MAX, Align.CENTER)))
        body += ear - ALONG_X * Cylinder(pivot_d / 2 + play, 100)
        for z in (first_z, second_z):
            body += Pos(side * hinge_x, hinge_y, z - axis_z) * Cylinder(knuckle_r, knuckle, align=UP)
            body += Pos(side * hinge_x, hinge_y, z - axis_z) * Cylinder(pin_d / 2, 2 * knuckle - 2, align=UP)
            web = Box(hinge_x - desk_half + 8, hinge_y - face_y, knuckle, align=(Align.MAX if side > 0 else Align.MIN, Align.MIN, Align.MIN))
            body += Pos(side * hinge_x, face_y, z - axis_z) * web
    return body


def flap_left(low, hinge_x, hinge_y, face_y, sheet, flap_end, flap_high, knuckle_r, pin_d, first_z, second_z, knuckle, play, start=4, float=0.3):
    """A sheet towards -x; its two knuckles sit on those of the desk."""
    body = Pos(start, face_y - hinge_y, 0) * Box(flap_end - hinge_x - start, sheet, flap_high - low, align=CORNER)
    body = fillet(body.edges().filter_by(Axis.Y).group_by(Axis.X)[-1], 8)
    for z in (first_z, second_z):
        bottom = z + knuckle + float - low
        body += Pos(0, 0, bottom) * Cylinder(knuckle_r, knuckle, align=UP)
        body += Pos(0, face_y - hinge_y, bottom) * Box(start + 8, hinge_y - face_y, knuckle, align=CORNER)
        body -= Pos(0, 0, bottom - 1) * Cylinder(pin_d / 2 + play, knuckle + 2, align=UP)
    return body.mirror(Plane.YZ)
