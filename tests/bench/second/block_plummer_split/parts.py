from build123d import Align, Axis, Box, Circle, Cylinder, GridLocations, Pos, Rectangle, RegularPolygon, Rot, chamfer, extrude, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def pedestal(axis_z, shaft_d, play, bolt_d, bolt_apart, wide, across, thread, long=160, thick=20, foot_hole=13, foot_apart=120, root=3):
    """Base with holes for the foot bolts; the lower half of the bore is open upwards."""
    body = Box(long, wide, thick, align=UP) + Box(across, wide, axis_z, align=UP)
    body = fillet(body.edges().filter_by(Axis.Y).filter_by(lambda e: abs(e.center().Z - thick) < 1e-6 and abs(abs(e.center().X) - across / 2) < 1e-6), root)
    body -= Pos(0, 0, axis_z) * Rot(90, 0, 0) * Cylinder(shaft_d / 2 + play, 2 * wide)
    for place in GridLocations(foot_apart, 1, 2, 1):
        body -= place * Cylinder(foot_hole / 2, 4 * thick)
    for place in GridLocations(bolt_apart, 1, 2, 1):
        body -= place * Pos(0, 0, axis_z - thread) * Cylinder(bolt_d / 2, 2 * thread, align=UP)
    return body


def cap(shaft_d, play, bolt_d, bolt_apart, wide, across, ear, cap_top, gap=0.4):
    """Upper half about y; two ears take the bolts."""
    arch = (Circle(cap_top) + Pos(0, ear / 2) * Rectangle(across, ear)) & Pos(0, cap_top) * Rectangle(2 * across, 2 * cap_top)
    body = Pos(0, wide / 2, 0) * Rot(90, 0, 0) * extrude(arch - Circle(shaft_d / 2 + play), wide)
    for place in GridLocations(bolt_apart, 1, 2, 1):
        body -= place * Cylinder(bolt_d / 2 + gap, 2 * cap_top, align=UP)
    return body


def spindle(shaft_d, length=200):
    bar = Cylinder(shaft_d / 2, length)
    return Rot(90, 0, 0) * chamfer(bar.edges(), 1)


def bolt(bolt_d, ear, thread, flats=16, head=6.4):
    """Under its head at z = 0."""
    return Cylinder(bolt_d / 2, ear + thread - 3, align=DOWN) + extrude(RegularPolygon(flats / 2, 6, major_radius=False), head)
