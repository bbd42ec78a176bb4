from build123d import Align, Axis, Box, Cylinder, PolarLocations, Pos, Rot, chamfer, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)
ALONG_X = Rot(Y=90)


def base(side, base_high, pivot_d, play, worm_y, worm_z, shaft_d, wheel_r, wheel_high, room, shaft_start, floor=5):
    """A cast block with a round room for the worm wheel, a bearing for the pivot below it, and a bore for the worm shaft."""
    body = Box(side, side, base_high, align=UP)
    body = fillet(body.edges().filter_by(Axis.Z), 3)
    body = chamfer(body.edges().group_by(Axis.Z)[-1], 1)
    low = worm_z - wheel_high / 2 - room
    body -= Pos(0, 0, low) * Cylinder(wheel_r + room, base_high, align=UP)
    body -= Pos(0, 0, floor) * Cylinder(pivot_d / 2 + play, base_high, align=UP)
    return body - Pos(shaft_start - 1, worm_y, worm_z) * ALONG_X * Cylinder(shaft_d / 2 + play, 2 * side, align=UP)


def round_table(table_d, table_thick, pivot_d, base_high, gap, worm_z, wheel_r, wheel_high, hole_d=9, circle=100, hub_d=52, floor=6):
    """The table above z = 0; below it hub, worm wheel (its pitch cylinder) and pivot."""
    plate = Cylinder(table_d / 2, table_thick, align=UP)
    body = chamfer(plate.edges(), 1)
    for place in PolarLocations(circle / 2, 4):
        body -= place * Cylinder(hole_d / 2, 3 * table_thick)
    down = base_high + gap
    body += Pos(0, 0, 1) * Cylinder(hub_d / 2, down - worm_z + 1, align=DOWN)
    body += Pos(0, 0, worm_z - down) * Cylinder(wheel_r, wheel_high)
    return body + Pos(0, 0, floor - down) * Cylinder(pivot_d / 2, worm_z - floor, align=UP)


def worm_shaft(shaft_d, shaft_start, wheel_x, hand_thick):
    """Along +x from the origin through the handwheel."""
    rod = ALONG_X * Cylinder(shaft_d / 2, wheel_x + hand_thick - shaft_start, align=UP)
    return chamfer(rod.edges().filter_by(lambda e: e.length > shaft_d), 0.5)


def handwheel(hand_d, hand_thick, shaft_d, handle=36, handle_d=9, handle_r=22):
    """A disc along +x from the origin, its handle at the bottom."""
    disc = ALONG_X * Cylinder(hand_d / 2, hand_thick, align=UP)
    body = fillet(disc.edges().filter_by(lambda e: e.length > hand_d), 1)
    peg = Pos(hand_thick - 1, 0, -handle_r) * ALONG_X * Cylinder(handle_d / 2, handle + 1, align=UP)
    body += fillet(peg.edges().sort_by(Axis.X)[-1], 1)
    return body - ALONG_X * Cylinder(shaft_d / 2, 5 * hand_thick)
