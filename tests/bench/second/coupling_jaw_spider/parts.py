from build123d import Align, Box, Circle, Cylinder, Pos, Rectangle, Rot, extrude, make_face, Polyline

X = Rot(0, 90, 0)
MIN_X = (Align.MIN, Align.CENTER, Align.CENTER)
LOBES = range(0, 360, 60)


def along(shape, length):
    """Extrude a shape, drawn with its x along z and its y along y, from x = 0."""
    return extrude(Rot(0, 90, 0) * shape, length)


def arm(wide, reach, turn):
    return Rot(0, 0, turn) * Pos(reach / 2, 0) * Rectangle(reach, wide)


def hub(across, jaw, barrel, bore_d, bore_deep, lobe, core, air):
    """Barrel behind the plane x = 0, three jaws before it, a blind bore from its outer end."""
    jaws = Circle(across / 2) - Circle(core / 2 + air)
    for turn in LOBES:
        jaws -= arm(lobe + 2 * air, across, turn)
    wedges = None
    for turn in (30, 150, 270):
        wedge = Rot(0, 0, turn) * make_face(Polyline((0, 0), (across, across / 2), (across, -across / 2), close=True))
        wedges = wedge if wedges is None else wedges + wedge
    body = Rot(0, -90, 0) * Cylinder(across / 2, barrel, align=(Align.CENTER, Align.CENTER, Align.MIN))
    body -= Pos(-barrel, 0, 0) * X * Cylinder(bore_d / 2, bore_deep, align=(Align.CENTER, Align.CENTER, Align.MIN))
    return body + Pos(-0.0, 0, 0) * along(jaws & wedges, jaw)


def star(star_d, star_thick, lobe, core, eye_d=8):
    shape = Circle(core / 2)
    for turn in LOBES:
        shape += arm(lobe, star_d, turn)
    shape = (shape & Circle(star_d / 2)) - Circle(eye_d / 2)
    return Pos(-star_thick / 2, 0, 0) * along(shape, star_thick)


def shaft(shaft_end, face, barrel, bore_d, bore_deep):
    return X * Cylinder(bore_d / 2, shaft_end - face - barrel + bore_deep, align=(Align.CENTER, Align.CENTER, Align.MIN))


def pedestal(across, play, height, thick=24, wide=76, foot=110, sole=14):
    """Foot below the shaft, which runs at the height."""
    body = Box(thick + 16, foot, sole, align=(Align.CENTER, Align.CENTER, Align.MIN))
    body += Box(thick, wide, height, align=(Align.CENTER, Align.CENTER, Align.MIN)) + Pos(0, 0, height) * X * Cylinder(wide / 2, thick)
    for side in (-1, 1):
        body -= Pos(0, side * (foot / 2 - 8), 0) * Cylinder(4.5, 4 * sole)
    return body - Pos(0, 0, height) * X * Cylinder(across / 2 + play, 2 * thick)
