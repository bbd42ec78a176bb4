"""Frame, blades, pins and bushes of the louvre; the stiles' frames are at their inner faces."""

from build123d import Align, Box, Circle, Cylinder, GeomType, Plane, Pos, Rot, SlotOverall, chamfer, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def along_x(diameter, long):
    return Rot(0, 90, 0) * Cylinder(diameter / 2, long)


def stile(side, stile_wide, deep, high, first_z, pitch, bush_d, bush_long, flange):
    """Side 1: the stile at -x, with blind seats for the bushes from its inner face."""
    body = Pos(-side * stile_wide / 2, 0, 0) * Box(stile_wide, deep, high, align=UP)
    for i in range(24):
        body -= Pos(0, 0, first_z + i * pitch) * along_x(bush_d, 2 * (bush_long - flange))
    return body


def sill(apart, deep, rail_high):
    return Box(apart, deep, rail_high, align=UP)


head = sill


def blade(blade_long, blade_wide, blade_thick, round_d, pin_d, pin_in):
    """Flat with rounded edges and a round along the middle, bored at both ends."""
    outline = SlotOverall(blade_wide, blade_thick) + Circle(round_d / 2)
    across = Plane((-blade_long / 2, 0, 0), x_dir=(0, 1, 0), z_dir=(1, 0, 0))
    body = extrude(across * outline, blade_long)
    for side in (-1, 1):
        body -= Pos(side * blade_long / 2, 0, 0) * along_x(pin_d, 2 * pin_in)
    return body


def pin(pin_d, pin_long, bevel=0.5):
    body = along_x(pin_d, pin_long)
    return chamfer(body.edges().filter_by(GeomType.CIRCLE), bevel)


def bush(inward, bush_d, bush_long, flange_d, flange, pin_d, play):
    """The flange lies on the stile's inner face, x = 0; inward is the side of the blade."""
    body = Pos(-inward * (bush_long - flange) / 2, 0, 0) * along_x(bush_d, bush_long - flange)
    body += Pos(inward * flange / 2, 0, 0) * along_x(flange_d, flange)
    return body - along_x(pin_d + play, 4 * bush_long)
