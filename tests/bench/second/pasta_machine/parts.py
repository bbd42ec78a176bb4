"""The stand is drawn in place; what turns along x has its origin on its axis."""

from build123d import Align, Axis, Box, Cylinder, Pos, Rot, SlotCenterPoint, chamfer, extrude, fillet

LOW = (Align.MIN, Align.MIN, Align.MIN)
UP = (Align.CENTER, Align.CENTER, Align.MIN)


def along_x(radius, low, high):
    return Pos(X=(low + high) / 2) * Rot(0, 90, 0) * Cylinder(radius, high - low)


def stand(axis_z, front_y, back_y, axle, play, left, inner_left, inner_right, right, foot_z, plate_z, knob_y, knob_z, stem, screw_x, screw_y, screw_d, clamp_z, clamp_top):
    """Foot, two side plates and the clamp's jaw, screwed for good."""
    body = Box(240, 130, plate_z - foot_z, align=LOW)
    body = Pos(0, 0, foot_z) * chamfer(body.edges().filter_by(Axis.Z), 2)
    for low, high in ((left, inner_left), (inner_right, right)):
        plate = Box(high - low, 110, 294 - plate_z + 4, align=LOW)
        body += Pos(low, 10, plate_z - 4) * chamfer(plate.edges().filter_by(Axis.X).group_by(Axis.Z)[-1], 3)
    for y in (front_y, back_y):
        body -= Pos(0, y, axis_z) * along_x(axle / 2 + play, 0, 240)
    body -= Pos(0, knob_y, knob_z) * along_x(stem / 2 + play, 0, inner_left + 1)
    body += Pos(screw_x - 30, 0, clamp_z) * (Box(60, 12, foot_z - clamp_z + 2, align=LOW) + Box(60, 61, clamp_top - clamp_z, align=LOW))
    return body - Pos(screw_x, screw_y, clamp_z - 1) * Cylinder(screw_d / 2 + play, clamp_top - clamp_z + 2, align=UP)


def roller(roll_d, axle, left, inner_left, inner_right, long=212):
    start = left - inner_left
    drum = along_x(roll_d / 2, 0.2, inner_right - inner_left - 0.2)
    rod = along_x(axle / 2, start, start + long)
    return chamfer(drum.edges(), 0.5) + chamfer(rod.edges(), 0.5)


roller_front = roller_back = roller


def crank(axle, hub_x, arm_x, throw, inner_left, left, arm=8, grip=18, end=307, long=212):
    hub = along_x(12.5, 0, arm_x + arm - hub_x)
    hub = chamfer(hub.edges().group_by(Axis.X)[-1], 1)
    bar = Rot(0, 0, 90) * Rot(90, 0, 0) * extrude(SlotCenterPoint((0, -throw / 2), (0, -throw), 15), arm)
    body = hub + Pos(arm_x - hub_x, 0, 0) * bar
    handle = along_x(grip / 2, arm_x - hub_x, end - hub_x)
    body += Pos(0, 0, -throw) * fillet(handle.edges().group_by(Axis.X)[-1], 2)
    return body - along_x(axle / 2, -1, left + long - hub_x)


def knob(stem, inner_left, left, thick=17, across=34):
    body = fillet(along_x(across / 2, -thick, -0.2).edges().group_by(Axis.X)[0], 2)
    body += along_x(stem / 2, -5, inner_left - left)
    return body + Pos(-7, 0, -3.5) * Box(6.8, across / 2 + 7, 7, align=LOW)


def screw(screw_d, clamp_z, top=94, pad=25):
    rod = Pos(0, 0, -clamp_z + 3) * Cylinder(screw_d / 2, top - 4, align=UP)
    plate = Pos(0, 0, top - 4 - clamp_z) * Cylinder(pad / 2, 4, align=UP)
    wing = Pos(0, 0, -clamp_z) * Box(41, 8, 7, align=UP)
    return rod + chamfer(plate.edges(), 0.5) + fillet(wing.edges().filter_by(Axis.Z), 2)
