from build123d import Align, Box, Cylinder, GridLocations, Pos, Rot, chamfer

FORE = (Align.MIN, Align.CENTER, Align.CENTER)
AFT = (Align.MAX, Align.CENTER, Align.CENTER)


def fork(root, knuckle, across, gap, slot, pin):
    """A fork about z, its root at x = -root; the pin bridges its cheeks."""
    body = Cylinder(knuckle, across) + Box(root, 2 * knuckle, across, align=AFT)
    body -= Cylinder(slot, gap) + Box(slot, 3 * knuckle, gap, align=AFT)
    return body + Cylinder(pin / 2, across)


def ring_and_hole(radius, gap, pin, play):
    return Cylinder(radius, gap - 2 * play), Cylinder(pin / 2 + play, 2 * gap)


def wall(ax, knuckle, across, gap, pin, plate, plate_wide, plate_high):
    body = Box(plate, plate_wide, plate_high, align=FORE)
    body = chamfer([e for e in body.edges() if abs(e.center().X - plate) < 0.1], 2)
    return body + Pos(ax, 0, 0) * fork(ax - plate + 1, knuckle, across, gap, ax - plate, pin)


def arm(reach, knuckle, across, gap, slot, eye, pin, play, bar):
    ring, hole = ring_and_hole(eye, gap, pin, play)
    body = ring + Box(reach - slot - 2, bar, bar, align=FORE) + Pos(reach, 0, 0) * fork(slot + 12, knuckle, across, gap, slot, pin)
    return body - hole


arm_near = arm_far = arm


def head(nod, gap, eye, pin, play, bar, barrel, barrel_wide, cross_pin):
    ring, hole = ring_and_hole(eye, gap, pin, play)
    body = ring + Box(nod, bar, bar, align=FORE) + Pos(nod, 0, 0) * Rot(90, 0, 0) * Cylinder(barrel / 2, barrel_wide)
    return body - hole - Pos(nod, 0, 0) * Rot(90, 0, 0) * Cylinder(cross_pin / 2 + play, 2 * barrel_wide)


def panel(tx, barrel, barrel_wide, cross_pin, play, face_x, face, face_thick, holes, hole, ear=7.5):
    """The plate with two ears, which hold the tilt pin."""
    far = face_x - tx
    body = Pos(far, 0, 0) * Box(face_thick, face, face, align=AFT)
    for place in GridLocations(holes, holes, 2, 2):
        body -= Pos(far, place.position.X, place.position.Y) * Rot(0, 90, 0) * Cylinder(hole / 2, 4 * face_thick)
    for y in (-1, 1):
        side = Pos(0, y * (barrel_wide / 2 + 2 * play + ear / 2), 0)
        body += side * Rot(90, 0, 0) * Cylinder(barrel / 2, ear) + side * Box(far - 1, ear, barrel, align=FORE)
    return body + Rot(90, 0, 0) * Cylinder(cross_pin / 2, barrel_wide + 2 * ear)
