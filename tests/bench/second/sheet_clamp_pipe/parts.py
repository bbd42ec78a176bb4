from build123d import Align, Box, Circle, Cylinder, GridLocations, Plane, Pos, Rectangle, RegularPolygon, Rot, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)
RIGHT = (Align.MIN, Align.CENTER, Align.MIN)


def cross(x, z, length, diameter):
    """A rod along y, about y = 0."""
    return Pos(x, 0, z) * Rot(X=90) * Cylinder(diameter / 2, length)


def saddle(axis_z, hinge_x, bolt_x, bolt_z, eye_d, pin_d, parting, wide, pipe_d, slot=12):
    body = Box(92, 62, 9, align=UP) - GridLocations(76, 46, 2, 2) * Cylinder(3.5, 40)
    body += Box(60, wide, axis_z - parting, align=UP)
    body += Pos(30, 0, 0) * Box(23, wide, 36, align=RIGHT)
    lugs = Pos(hinge_x, 0, axis_z - eye_d / 2) * Box(-hinge_x - 30, wide, eye_d / 2 - parting, align=RIGHT) + cross(
        hinge_x, axis_z, wide, eye_d
    )
    body += lugs - Pos(hinge_x, 0, axis_z) * Box(20, slot, 40)
    body -= Pos(31, 0, 15) * Box(40, slot, 40, align=RIGHT)
    body -= cross(0, axis_z, 2 * wide, pipe_d)
    return body - cross(hinge_x, axis_z, 2 * wide, pin_d) - cross(bolt_x, bolt_z, 2 * wide, pin_d)


def cap(hinge_x, eye_d, turning_d, parting, wide, pipe_d, outside=60, eye_wide=11.8, ear=10, ear_end=52, slot=9, slot_start=36):
    """About the hinge's axis; the pipe is at +x."""
    arch = Circle(outside / 2) + Pos(0, ear / 2) * Rectangle(2 * ear_end, ear) - Pos(-ear_end / 2, 0) * Rectangle(ear_end, 4 * ear)
    arch = Circle(outside / 2) + arch
    arch = arch - Circle(pipe_d / 2) - Pos(0, parting - 50) * Rectangle(200, 100)
    body = Pos(-hinge_x, 0, 0) * extrude(Plane.XZ * arch, wide / 2, both=True)
    body -= Pos(slot_start - hinge_x, 0, -50) * Box(50, slot, 100, align=RIGHT)
    link = Pos(0, 0, parting) * Box(-hinge_x - 25, eye_wide, eye_d / 2 - parting, align=RIGHT)
    return body + link + cross(0, 0, eye_wide, eye_d) - cross(0, 0, 2 * wide, turning_d)


def hinge_pin(pin_d, wide):
    return cross(0, 0, wide, pin_d)


bolt_pin = hinge_pin


def eyebolt(turning_d, shank_d, eye=17, eye_wide=11.6, reach=50):
    body = cross(0, 0, eye_wide, eye) + Rot(Y=90) * Cylinder(shank_d / 2, reach, align=UP)
    return body - cross(0, 0, 40, turning_d)


def nut(shank_d, flats=13, high=9, flange_d=19, flange=2):
    body = extrude(RegularPolygon(flats / 2, 6, major_radius=False), high) + Cylinder(flange_d / 2, flange, align=UP)
    return body - Cylinder(shank_d / 2, 4 * high)
