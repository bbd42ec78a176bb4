from build123d import Align, Axis, Box, Circle, Cylinder, GridLocations, Plane, Pos, Rectangle, RectangleRounded, RegularPolygon, Rot, chamfer, extrude, fillet, make_hull

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def _hull(*circles):
    """The plane figure round circles (x, z, radius), upright in y = 0."""
    shapes = [Pos(x, z) * Circle(r) for x, z, r in circles]
    return make_hull([edge for shape in shapes for edge in shape.edges()])


def _plate(figure, thick, y=0):
    """The figure as a plate whose middle is at y."""
    return Pos(0, y, 0) * extrude(Plane.XZ * figure, thick / 2, both=True)


def base(part, b_z, a_x, a_z, inner, cheek, foot_front=50, foot_back=22, foot_half=26, foot=5, stop_gap=0.15):
    length = foot_front + foot_back
    flat = Pos((foot_front - foot_back) / 2, 0) * RectangleRounded(length, 2 * foot_half, 4)
    for place in GridLocations(length - 16, 2 * foot_half - 14, 2, 2):
        flat -= Pos((foot_front - foot_back) / 2, 0) * place * Circle(3.25)
    body = extrude(flat, foot)
    outline = _hull((0, b_z, 10), (a_x, a_z, 10), (-8, 4, 4), (a_x + 6, 4, 4))
    for y in (-1, 1):
        body += _plate(outline, cheek, y * (inner + cheek / 2))
    body += Pos(9.5, 0, b_z - 8 - stop_gap) * Box(9, 2 * inner + 1, 6, align=(Align.CENTER, Align.CENTER, Align.MAX))
    return part.made(body)


def handle(part, crank, over_deg, plate, inner, d_x, d_z, b_z, grip_at, grip, tang_wide):
    body = _plate(_hull((0, 0, 8), (d_x, d_z - b_z, 6.5)), plate)
    body += Pos(0, 0, 0) * Box(tang_wide, plate, grip_at + grip - 6, align=UP)
    body += Rot(X=90) * Cylinder(8, 2 * inner - 0.6)
    return part.made(body)


def arm(part, a_x, a_z, c_x, c_z, plate, inner, tip, thread_d, thread_z, boss_d=18):
    body = _plate(_hull((0, 0, 8), (c_x - a_x, c_z - a_z, 6.5)), plate)
    body += _plate(_hull((0, 0, 8), (tip, 0, 6)), plate)
    body += Rot(X=90) * Cylinder(8, 2 * inner - 0.6)
    body += Pos(tip, 0, a_z - thread_z) * Cylinder(boss_d / 2, 2 * (thread_z - a_z), align=UP)
    body -= Pos(tip, 0, 0) * Cylinder(thread_d / 2 + 0.1, 60)
    return part.made(body)


def link(part, d_along, d_down, plate, strap, side):
    return part.made(_plate(_hull((0, 0, 6), (d_along, d_down, 6)), strap, plate / 2 + side + strap / 2))


def grip(grip, plate, tang_wide, wide=20, deep=16):
    """A rubber sleeve above the origin, closed at its top."""
    body = extrude(RectangleRounded(wide, deep, 5), grip)
    body = fillet(body.faces().sort_by(Axis.Z)[-1].edges(), 3)
    return body - Box(tang_wide, plate, grip - 6, align=UP)


def spindle(thread_d, thread_z, above=9, head=8, below=29):
    rod = Pos(0, 0, -below) * Cylinder(thread_d / 2, below + above + 1, align=UP)
    rod = fillet(rod.faces().sort_by(Axis.Z)[0].edges(), 2)
    return rod + Pos(0, 0, above) * extrude(RegularPolygon(6.5, 6, major_radius=False), head)
