"""Base and pan stand on z = 0; the tilt's origin is on its axis, that of roll and slide on the roll axis."""

from build123d import Align, Axis, Box, Cylinder, Pos, Rot, chamfer, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def along_x(radius, low, high):
    return Pos(X=(low + high) / 2) * Rot(0, 90, 0) * Cylinder(radius, high - low)


def along_y(radius, long):
    return Rot(90, 0, 0) * Cylinder(radius, long)


def base(base, post=20, post_d=16):
    body = chamfer(Cylinder(30, base, align=UP).edges().group_by(Axis.Z)[0], 1)
    stud = Cylinder(post_d / 2, base + post, align=UP)
    return body + chamfer(stud.edges().group_by(Axis.Z)[-1], 1)


def pan(base, tilt_z, cheek, across, trunnion, play, post=20, post_d=16, top=38.2):
    body = Pos(0, 0, base + 0.2) * Cylinder(28, top - base - 0.2, align=UP)
    body = fillet(body.edges().group_by(Axis.Z)[-1], 1)
    body -= Pos(0, 0, base) * Cylinder(post_d / 2 + play, post + 0.6, align=UP)
    for side in (-1, 1):
        ear = Box(24.5, cheek, 64.5 - top + 4, align=UP)
        ear = chamfer(ear.edges().filter_by(Axis.Y).group_by(Axis.Z)[-1], 1)
        body += Pos(0, side * (across - cheek) / 2, top - 4) * ear
    return body - Pos(0, 0, tilt_z) * along_y(trunnion / 2 + play, 2 * across)


def tilt(tilt_z, roll_z, tongue, across, trunnion, roll_d, top=97):
    """A tongue, round about its axis, with a trunnion; the roll's journal along x ends in a head."""
    body = along_y(8, tongue) + Pos(0, 0, -1.5) * Box(25, tongue, top - tilt_z + 1.5, align=UP) + along_y(trunnion / 2, across)
    return body + Pos(0, 0, roll_z - tilt_z) * along_x(roll_d / 2, 0, 40.5)


def roll(across, roll_d, play, slide_wide, low=-20.5, plate_z=17.3):
    block = Pos(24, 0, low) * Box(20, across, plate_z - low + 1, align=UP)
    block = fillet(block.edges().filter_by(Axis.X).group_by(Axis.Z)[0], 2)
    block -= along_x(roll_d / 2 + play, 0, 60)
    body = block + Pos(28, 0, plate_z) * Box(64, 52.5, 8, align=UP)
    for side in (-1, 1):
        body += Pos(28, side * (slide_wide / 2 + 0.15 + 3.5), plate_z + 7) * Box(64, 7, 9, align=UP)
    return body


def slide(slide_wide, plate_z=25.5, thick=8):
    plate = Pos(0, 0, plate_z) * Box(70, slide_wide, thick, align=UP)
    plate = chamfer(plate.edges().filter_by(Axis.Z), 1)
    stud = Pos(0, 0, plate_z + thick / 2) * Cylinder(3.175, thick / 2 + 5, align=UP)
    return plate + chamfer(stud.edges().group_by(Axis.Z)[-1], 0.5)
