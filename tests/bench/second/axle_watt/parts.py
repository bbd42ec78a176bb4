"""Bars lie in 0 < y < thick, the cross-member in front of them, centre piece and axle behind."""

from build123d import Align, Axis, Box, Circle, Cylinder, Plane, Pos, Rot, SlotCenterToCenter, extrude, fillet

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FLAT = Plane((0, 0, 0), x_dir=(1, 0, 0), z_dir=(0, 1, 0))  # drawn in XZ, extruded to +y; its y is -z


def rod(x, z, y, long, radius):
    return Pos(x, y, z) * Rot(X=-90) * Cylinder(radius, long, align=LOW)


def cross_member(bar, link, thick, air, pin_d, side=50, plate=10, flange=36):
    """A square beam with a bracket upwards at the left, one downwards at the right."""
    beam = Pos(0, thick + air + plate + side / 2, 0) * Box(2 * bar + 80, side, side)
    for end in (-1, 1):
        high = link / 2 + flange / 2 + side / 2
        lug = Pos(end * bar, thick + air + plate / 2, -end * (high / 2 - side / 2)) * Box(flange, plate, high)
        beam += fillet(lug.edges().filter_by(Axis.Y).group_by(Axis.Z)[-1 if end < 0 else 0], 12)
        beam += rod(end * bar, -end * link / 2, 0, thick + air + 1, pin_d / 2)
    return beam


def bar(bar, wide, thick, pin_d, play):
    """Flat bar along x from its pivot at the origin."""
    hole = Circle(pin_d / 2 + play)
    return FLAT * extrude(Pos(bar / 2, 0) * SlotCenterToCenter(bar, wide) - hole - Pos(bar, 0) * hole, thick)


bar_left = bar


def bar_right(bar, wide, thick, pin_d, play):
    """The same bar."""
    hole = Circle(pin_d / 2 + play)
    return FLAT * extrude(Pos(bar / 2, 0) * SlotCenterToCenter(bar, wide) - hole - Pos(bar, 0) * hole, thick)


def centre_piece(link, thick, air, pin_d, play, wide=30):
    """Upright link behind the bars, with a stud at either end."""
    body = extrude(Pos(0, 0) * Rot(0, 0, 90) * SlotCenterToCenter(link, wide) - Circle(pin_d / 2 + play), thick)
    body = Pos(0, -air - thick, 0) * (FLAT * body)
    for z in (-link / 2, link / 2):
        body += rod(0, z, -air - 1, thick + air + 1, pin_d / 2)
    return body


def axle(thick, air, pin_d, tube=60, wall=4, long=620):
    """A tube along x behind its pin, which is at the origin's front."""
    middle = -tube / 2 - 4
    body = Pos(0, middle, 0) * Rot(Y=90) * Cylinder(tube / 2, long)
    body += rod(0, 0, middle, -middle, 14)
    body += rod(0, 0, middle, -middle + air + thick, pin_d / 2)
    return body - Pos(0, middle, 0) * Rot(Y=90) * Cylinder(tube / 2 - wall, 2 * long)
