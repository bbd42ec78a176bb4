from math import cos, radians, sin

from build123d import Align, Box, Cone, Cylinder, Pos, Rot, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)
ON = (Align.MIN, Align.CENTER, Align.MIN)
ALONG_X = Rot(0, 90, 0)


def body(axis_z, body, body_d, sole, sole_high, neck, quill, clear, screw, key, lever_x, lever_hub, boss_z, pivot, wall=12):
    """Barrel on a neck and a sole, bored from the front up to a rear wall, with a key at the front."""
    solid = Pos(0, 0, axis_z) * ALONG_X * Cylinder(body_d / 2, body, align=UP)
    solid += Box(body, sole, sole_high, align=ON) + Box(body, neck, axis_z, align=ON)
    solid += Pos(lever_x, 0, axis_z) * Cylinder(lever_hub / 2, boss_z - axis_z, align=UP)
    solid -= Pos(-1, 0, axis_z) * ALONG_X * Cylinder(quill / 2 + clear, body - wall + 1, align=UP)
    solid -= Pos(0, 0, axis_z) * ALONG_X * Cylinder(screw / 2 + 0.15, 2 * body, align=UP)
    solid -= Pos(lever_x, 0, boss_z) * Cylinder(pivot / 2 + 0.1, 12, align=DOWN)
    return solid + Pos(5, 0, axis_z - quill / 2 - 4) * Box(20, key, 6.6, align=ON)


def quill(quill, nose, quill_long, tang, tang_long, screw, screw_long, body, key):
    """Sticks out by its nose at x = -nose; bored for the point in front, for the screw behind, with a groove below."""
    solid = Pos(-nose, 0, 0) * ALONG_X * Cylinder(quill / 2, quill_long, align=UP)
    solid -= Pos(-nose, 0, 0) * ALONG_X * Cylinder(tang / 2, tang_long, align=UP)
    solid -= Pos(body - screw_long - 2, 0, 0) * ALONG_X * Cylinder(screw / 2 + 0.1, quill_long, align=UP)
    return solid - Pos(3, 0, -quill / 2) * Box(quill_long, key + 0.3, 6, align=(Align.MIN, Align.CENTER, Align.CENTER))


def point(cone, cone_long, tang, tang_long):
    return ALONG_X * (Pos(0, 0, -cone_long) * Cone(0, cone / 2, cone_long, align=UP) + Cylinder(tang / 2, tang_long - 1, align=UP))


def handwheel(screw, screw_long, wheel, hub, hub_long, rim, handle, handle_long, handle_r):
    solid = Pos(0, 0, hub_long) * Cylinder(wheel / 2, rim, align=UP)
    solid = fillet(solid.edges(), 1.5) + Pos(0, 0, 0.3) * Cylinder(hub / 2, hub_long, align=UP)
    solid += Pos(0, 0, 1) * Cylinder(screw / 2, screw_long + 1, align=DOWN)
    return ALONG_X * (solid + Pos(handle_r, 0, hub_long + rim - 1) * Cylinder(handle / 2, handle_long + 1, align=UP))


def lever(lever_hub, boss_z, hub_top, pivot, rod, rod_z, rod_long, lift_deg=30):
    """A hub with a rod that rises to the back."""
    solid = Cylinder(lever_hub / 2, hub_top - boss_z, align=UP) + Cylinder(pivot / 2, 11, align=DOWN)
    axis = Pos(0, rod_long / 2 * cos(radians(lift_deg)), rod_z - boss_z + rod_long / 2 * sin(radians(lift_deg)))
    return solid + axis * Rot(lift_deg - 90, 0, 0) * Cylinder(rod / 2, rod_long)
