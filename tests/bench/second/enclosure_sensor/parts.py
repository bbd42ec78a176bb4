from build123d import Align, Box, Circle, Cylinder, GridLocations, Pos, Rectangle, Rot, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def tray(long, wide, tray_high, pitch_x, pitch_y, pilot, pilot_deep, wall=2.5, boss=8, cable=10):
    """A box without lid; the bosses grow into its corners."""
    outside = Rectangle(long, wide)
    bosses = GridLocations(pitch_x, pitch_y, 2, 2) * Circle(boss / 2)
    walls = (outside - Rectangle(long - 2 * wall, wide - 2 * wall)) + bosses
    body = extrude(outside, wall) + extrude(walls, tray_high)
    for place in GridLocations(pitch_x, pitch_y, 2, 2):
        body -= Pos(0, 0, tray_high) * place * Cylinder(pilot / 2, pilot_deep, align=DOWN)
    return body - Pos(long / 2, 0, tray_high / 2) * Rot(Y=90) * Cylinder(cable / 2, 4 * wall)


def lid(long, wide, lid_thick, pitch_x, pitch_y, clearance=3.2):
    return extrude(Rectangle(long, wide) - GridLocations(pitch_x, pitch_y, 2, 2) * Circle(clearance / 2), lid_thick)


def screw(lid_thick, pilot, shank=3, head=5.5, head_high=2, bite=10):
    """Head above z = 0, shank through the lid, core in the boss."""
    body = Cylinder(head / 2, head_high, align=UP) + Cylinder(shank / 2, lid_thick, align=DOWN)
    return body + Cylinder(pilot / 2, lid_thick + bite, align=DOWN)
