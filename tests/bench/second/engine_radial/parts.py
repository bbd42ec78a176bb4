"""The master rod lies behind y = 0, the other rods before it; the crank's web is behind the master rod."""

from build123d import Align, Axis, Box, Circle, Cylinder, Plane, Pos, Rectangle, Rot, chamfer, extrude

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
WEB = 8  # front of the crank's web
BACK = 16  # front of the case's plate


def along_y(x, z, start, end, radius):
    return Pos(x, start, z) * Rot(X=-90) * Cylinder(radius, end - start, align=LOW)


def case(piston_d, gap, reach_top, wall, shaft_d, pin_play, layer, air, disc_d=104, plate=8, low=62, strap=18, slot_top=92):
    """A round plate with a sleeve on a strap for each cylinder."""
    bore = piston_d / 2 + gap
    body = along_y(0, 0, BACK, BACK + plate, disc_d / 2)
    turns = [Rot(Y=72 * i) for i in range(5)]
    for turn in turns:
        body += turn * Pos(0, (bore + BACK + plate) / 2, (40 + reach_top) / 2) * Box(strap, BACK + plate - bore, reach_top - 40)
    body -= along_y(0, 0, -BACK, BACK, 46)
    for turn in turns:
        body += turn * Pos(0, 0, low) * Cylinder(bore + wall, reach_top - low, align=LOW)
    slot = 2 * (layer + air + 1)
    for turn in turns:
        body -= turn * Pos(0, 0, low - 20) * Cylinder(bore, reach_top, align=LOW)
        body -= turn * Pos(0, 0, low - 1) * Box(60, slot, slot_top - low, align=LOW)
    return body - along_y(0, 0, 0, 60, shaft_d / 2 + pin_play)


def crank(throw, crank_d, shaft_d, layer, air, shaft_end=38.6):
    """Pin at +z, before the web."""
    web = Circle(throw + 10)
    body = Pos(0, WEB, 0) * Rot(X=-90) * extrude(web, BACK - WEB - air)
    body += along_y(0, 0, WEB + 1, shaft_end, shaft_d / 2)
    body = chamfer(body.edges().group_by(Axis.Y)[-1], 1)
    return body + along_y(0, throw, 0, WEB + 1, crank_d / 2) + along_y(0, throw, WEB - air, WEB + 1, crank_d / 2 + 3)


def eyed(long, wide, end_d, eye_d):
    """Outline of a rod from the origin along y of the sketch, both ends bored."""
    outline = Pos(0, long / 2) * Rectangle(wide, long) + Circle(end_d / 2) + Pos(0, long) * Circle(end_d / 2)
    return outline - Circle(eye_d / 2) - Pos(0, long) * Circle(eye_d / 2)


def standing(sketch, start, thick):
    """Extruded to +y, from y = start; y of the sketch becomes z."""
    return extrude(Plane((0, start + thick, 0), x_dir=(1, 0, 0), z_dir=(0, -1, 0)) * sketch, thick)


def master(master_long, knuckle_r, pin_d, pin_play, crank_d, layer, air, wide=9, rim=6, small_end=12):
    outline = Circle(knuckle_r + rim) + Pos(0, master_long / 2) * Rectangle(wide, master_long) + Pos(0, master_long) * Circle(small_end / 2)
    outline -= Circle(crank_d / 2 + pin_play) + Pos(0, master_long) * Circle(pin_d / 2 + pin_play)
    body = standing(outline, air, layer)
    for i in range(1, 5):
        body += Rot(Y=72 * i) * along_y(0, knuckle_r, -layer - air, air + 1, pin_d / 2)
    return body


def rod(rod_long, pin_d, pin_play, layer, air, wide=7, end_d=11):
    return standing(eyed(rod_long, wide, end_d, pin_d + 2 * pin_play), -layer - air, layer)


def piston(piston_d, pin_d, layer, air, crown=9.5, skirt=8, top=2.7):
    """Its pin is about y through the origin, its crown at +z."""
    body = Pos(0, 0, -skirt) * Cylinder(piston_d / 2, skirt + crown, align=LOW)
    body -= Pos(0, 0, -skirt) * Box(2 * piston_d, 2 * (layer + 2 * air), skirt + crown - top, align=(Align.CENTER, Align.CENTER, Align.MIN))
    return body + along_y(0, 0, -layer - 2 * air - 1, layer + 2 * air + 1, pin_d / 2)
