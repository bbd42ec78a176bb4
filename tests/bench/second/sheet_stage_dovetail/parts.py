from build123d import Align, Box, Cylinder, Plane, Polygon, Pos, Rot, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def prism(long, *points):
    """A polygon of y and z along x, about x = 0."""
    return extrude(Plane.YZ * Polygon(*points, align=None), long / 2, both=True)


def base(long, wide, plate, rise, neck, top, screw, pitch_x=110, pitch_y=52, head=10, sunk=5, through=5.5, dowel_deep=7):
    low, high = neck / 2, top / 2
    body = Box(long, wide, plate, align=UP) + prism(long, (-low, plate - 1), (-low, plate), (-high, plate + rise), (high, plate + rise), (low, plate), (low, plate - 1))
    for x in (-pitch_x / 2, pitch_x / 2):
        for y in (-pitch_y / 2, pitch_y / 2):
            body -= Pos(x, y, plate) * Cylinder(head / 2, sunk, align=DOWN) + Pos(x, y, plate) * Cylinder(through / 2, 3 * plate)
    for x, y in ((17 - long / 2, 45 - wide / 2), (95 - long / 2, 9 - wide / 2)):
        body -= Pos(x, y, 0) * Cylinder(screw / 2, dowel_deep, align=UP)
    return body


def carriage(carriage, wide, tall, neck, lean, play, flank, recess, gib, screw, screw_z, eye=18, eye_deep=8, tapped=3.3, tapped_deep=7, pitch=40):
    """Its underside is z = 0; the gib's side is -y."""
    right = neck / 2 + lean * play + flank
    left = right + gib
    body = Box(carriage, wide, tall, align=UP)
    body -= prism(2 * carriage, (-left, 0), (-left - lean * recess, recess), (right + lean * recess, recess), (right, 0))
    body -= Pos(0, -left + 1, screw_z) * Rot(90, 0, 0) * Cylinder(screw / 2, wide, align=UP)
    body -= Pos(0, 0, tall) * Cylinder(eye / 2, eye_deep, align=DOWN)
    for x in (-pitch / 2, pitch / 2):
        for y in (-pitch / 2, pitch / 2):
            body -= Pos(x, y, tall) * Cylinder(tapped / 2, tapped_deep, align=DOWN)
    return body


def gib(carriage, neck, lean, play, flank, gib, gib_high):
    near = neck / 2 + lean * play + flank
    return prism(carriage, (-near, 0), (-near - lean * gib_high, gib_high), (-near - gib - lean * gib_high, gib_high), (-near - gib, 0))


def screw(screw, collar, collar_long, head, head_long, shank):
    body = Cylinder(collar / 2, collar_long, align=UP) + Pos(0, 0, collar_long) * Cylinder(head / 2, head_long, align=UP)
    return body + Cylinder(screw / 2, shank, align=DOWN)
