from build123d import Align, Axis, Box, Circle, Cylinder, Plane, Polygon, Pos, Rectangle, Rot, chamfer, extrude, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def bracket(axis, pitch, hub_high, pin_d, play, lug, lug_wide, air, top, plate=8, margin=18, screw_d=6.5):
    """A plate on the wall with four lugs for the pin."""
    high = top + lug + 2 * margin
    body = Pos(0, -plate / 2, -lug - margin) * Box(lug_wide + 16, plate, high + lug, align=UP)
    shape = Circle(lug_wide / 2) + Pos(0, axis / 2) * Rectangle(lug_wide, axis - 1) - Circle(pin_d / 2 + play)
    for z in (-lug, pitch - lug, 2 * pitch - lug, top):
        body += Pos(0, -axis, z) * extrude(shape, lug)
    for z in (-lug - margin / 2, pitch - lug - 20, 2 * pitch - lug - 20, top + lug + margin / 2):
        body -= Pos(0, 0, z) * Rot(X=90) * Cylinder(screw_d / 2, 4 * plate)
    return body


def pin(pin_d, top, lug, head_d=18, head=5):
    """Hangs from z = 0, with its head above."""
    rod = Cylinder(pin_d / 2, top + 2 * lug + 4, align=DOWN)
    return chamfer(rod.edges().group_by(Axis.Z)[0], 1) + Cylinder(head_d / 2, head, align=UP)


def rail(reach, wide, hub_high, tip_high, pin_d, play, straight=40, rounded=2):
    """Along +x from the pin, level above, tapering below."""
    outline = [(-wide / 2, 0), (straight, 0), (reach, hub_high - tip_high), (reach, hub_high), (-wide / 2, hub_high)]
    body = extrude(Plane.XZ * Polygon(*outline, align=None), wide / 2, both=True)
    body = fillet(body.edges().filter_by(Axis.Z).group_by(Axis.X)[0], wide / 2 - 0.1)
    body = fillet(body.faces().sort_by(Axis.Z)[-1].edges().filter_by(Axis.X), rounded)
    return body - Cylinder(pin_d / 2 + play, 4 * hub_high)


rail_low = rail_middle = rail_high = rail
