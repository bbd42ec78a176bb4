from build123d import Align, Axis, Box, Cylinder, Pos, Rot, chamfer

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def along_x(radius, low, high, y=0, z=0):
    return Pos((low + high) / 2, y, z) * Rot(0, 90, 0) * Cylinder(radius, high - low)


def rib(long, neck_wide, neck_high, head_wide, head_high, play=0):
    """T section along x above z = 0; with play, the slot for it."""
    body = Box(long, neck_wide + 2 * play, neck_high + 0.5, align=UP)
    return body + Pos(0, 0, neck_high - play) * Box(long, head_wide + 2 * play, head_high + 2 * play, align=UP)


def bed(sole, neck_wide, neck_high, head_wide, head_high, play, spindle_z, spindle_d, wall_x, wall, dial_y, stud_d, wide=110, tall=66):
    """Sole with a T rib between two end walls; a stud for the dial on the right one."""
    end = wall_x + wall
    body = Box(2 * end, wide, sole, align=UP)
    body = chamfer(body.edges().filter_by(Axis.Z), 4)
    body += Pos(0, 0, sole) * rib(2 * wall_x + 4, neck_wide, neck_high, head_wide, head_high)
    for side in (-1, 1):
        body += Pos(side * (wall_x + wall / 2), -10, 0) * Box(wall, 84, tall, align=UP)
    body -= along_x(spindle_d / 2 + play, -2 * end, 2 * end, 0, spindle_z)
    return body + along_x(stud_d / 2, end - 2, end + 9, dial_y, spindle_z)


def jaw(jaw_wide, jaw_long, sole, neck_wide, neck_high, head_wide, head_high, play, spindle_z, spindle_d, high=72):
    body = Pos(0, 0, play) * Box(jaw_long, jaw_wide, high, align=UP)
    body = chamfer(body.edges().filter_by(Axis.Y).group_by(Axis.Z)[-1].sort_by(Axis.X)[-1], 10)
    body -= rib(2 * jaw_long, neck_wide, neck_high, head_wide, head_high, play)
    return body - along_x(spindle_d / 2 + play, -jaw_long, jaw_long, 0, spindle_z - sole)


def spindle(spindle_d, wall_x, wall, collar_d=24, collar=5, gap=0.2, out=26, arm=60, knob=36):
    """Collars inside both walls; the crank outside on the right."""
    end = wall_x + wall
    body = along_x(spindle_d / 2, -end, end + out)
    for side in (-1, 1):
        body += Pos(side * (wall_x - gap - collar / 2), 0, 0) * Rot(0, 90, 0) * Cylinder(collar_d / 2, collar)
    body += Pos(end + out - 5, 0, 0) * Box(10, 20, 2 * spindle_d) + Pos(end + out - 5, 0, 0) * Box(10, 16, arm, align=UP)
    return body + along_x(7, end + out - 4, end + out + knob, 0, arm - 7)


def dial(dial_d, stud_d, play, gap=0.5, thick=7):
    """A disc with a mark at its rim."""
    body = along_x(dial_d / 2, gap, gap + thick) - along_x(stud_d / 2 + play, -1, 3 * thick)
    return body - Pos(gap + thick, 0, dial_d / 2 - 5) * Box(1.6, 1.6, 6)
