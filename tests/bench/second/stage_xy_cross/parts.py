from build123d import Align, Axis, Box, Cylinder, Pos, Rot, chamfer

UP = (Align.CENTER, Align.CENTER, Align.MIN)
CORNER = (Align.MIN, Align.MIN, Align.MIN)


def along_x(radius, low, high, y=0, z=0):
    return Pos((low + high) / 2, y, z) * Rot(0, 90, 0) * Cylinder(radius, high - low)


def rail(long, neck_wide, head_wide, neck_high, head_high, play=0):
    """T section along x above z = 0; with play, the slot for it."""
    body = Box(long, neck_wide + 2 * play, neck_high + 0.5, align=UP)
    return body + Pos(0, 0, neck_high - play) * Box(long, head_wide + 2 * play, head_high + 2 * play, align=UP)


def bed(wide, bed_high, neck_wide, head_wide, neck_high, head_high, mid_y, screw_d, screw_x_y, screw_x_z, bracket, bracket_x, play, tall=40):
    long = bracket_x + bracket / 2
    body = Box(long, wide, bed_high, align=CORNER) + Pos(bracket_x, mid_y, 0) * Box(bracket, wide, tall, align=UP)
    body += Pos(bracket_x / 2, mid_y, bed_high) * rail(bracket_x, neck_wide, head_wide, neck_high, head_high)
    return body - along_x(screw_d / 2 + play, bracket_x - bracket, 2 * long, screw_x_y, screw_x_z)


def saddle(wide, bed_high, saddle_top, neck_wide, head_wide, neck_high, head_high, mid_x, mid_y, screw_d, screw_x_y, screw_x_z, screw_y_x, screw_y_z, bracket, bracket_y, play, front=75, tall=72):
    """Slot along x below; above a rail along y with a bracket at its back end."""
    high = saddle_top - bed_high
    body = Pos(0, 0, play) * Box(wide, wide, high - play, align=UP) - rail(2 * wide, neck_wide, head_wide, neck_high, head_high, play)
    back = bracket_y - mid_y
    body += Pos(0, (back - front) / 2, high) * Rot(0, 0, 90) * rail(back + front, neck_wide, head_wide, neck_high, head_high)
    left, right = -head_wide / 2, screw_y_x - mid_x + 15
    body += Pos((left + right) / 2, back, high) * Box(right - left, bracket, tall - saddle_top, align=UP)
    body -= along_x(screw_d / 2 + play, -wide, wide, screw_x_y - mid_y, screw_x_z - bed_high)
    return body - Pos(screw_y_x - mid_x, back, screw_y_z - bed_high) * Rot(90, 0, 0) * Cylinder(screw_d / 2 + play, 3 * bracket)


def table(wide, saddle_top, table_top, neck_wide, head_wide, neck_high, head_high, mid_x, screw_d, screw_y_x, screw_y_z, play):
    body = Pos(0, 0, play) * Box(wide, wide, table_top - saddle_top - play, align=UP)
    body = chamfer(body.edges().group_by(Axis.Z)[-1], 1)
    body -= Rot(0, 0, 90) * rail(2 * wide, neck_wide, head_wide, neck_high, head_high, play)
    return body - Pos(screw_y_x - mid_x, 0, screw_y_z - saddle_top) * Rot(90, 0, 0) * Cylinder(screw_d / 2 + play, 2 * wide)


def screw(reach, out, screw_d, bracket, collar, gap, knob_d=24, knob=10, collar_d=13):
    """About the middle of its bracket along x, the knob at out."""
    body = along_x(screw_d / 2, -reach, out) + along_x(knob_d / 2, out - knob, out)
    face = bracket / 2 + gap
    return body + along_x(collar_d / 2, -face - collar, -face) + along_x(collar_d / 2, face, face + collar)


def screw_x(bracket_x, end_x, screw_d, bracket, collar, gap, reach=136):
    return screw(reach, end_x - bracket_x, screw_d, bracket, collar, gap)


def screw_y(bracket_y, end_y, screw_d, bracket, collar, gap, reach=100):
    return Rot(0, 0, 90) * screw(reach, end_y - bracket_y, screw_d, bracket, collar, gap)
