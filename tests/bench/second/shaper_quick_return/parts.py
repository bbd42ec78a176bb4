"""Flat parts lie in XZ with their back face at y = 0; pins point to the front, the ram's to the back."""

from math import cos, radians, sin

from build123d import Align, Axis, Box, Circle, Cylinder, Pos, Rectangle, Rot, SlotCenterPoint, SlotCenterToCenter, chamfer, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)
FLAT = Rot(90, 0, 0)
FRAME_X = -40


def stud(x, z, radius, back, front):
    return Pos(x, back, z) * FLAT * Cylinder(radius, back - front, align=UP)


def along_x(radius, low, high):
    return Pos(X=(low + high) / 2) * Rot(0, 90, 0) * Cylinder(radius, high - low)


def frame(pivot_z, above, ram_z, air, wheel_t, thick, lever_y, pin_d, rod_d, rod_y, axle=16, board=8, high=236, deep=80, base=17):
    """A board like a T on a foot; axle, pivot with a shoulder, and the ram's rod between two brackets."""
    foot = Pos(0, deep / 2 - 35, 0) * Box(150, deep, base, align=UP)
    foot = chamfer(foot.edges().filter_by(Axis.Z), 4)
    front = (Align.CENTER, Align.MIN, Align.MIN)
    body = foot + Pos(0, 0, 5) * Box(150, board, high - 5, align=front) + Pos(FRAME_X, 0, high - 50) * Box(340, board, 50, align=front)
    body += stud(0, pivot_z + above, axle / 2, board / 2, -air - wheel_t)
    body += stud(0, pivot_z, pin_d / 2 + 3, board / 2, lever_y + air / 2) + stud(0, pivot_z, pin_d / 2, board / 2, lever_y - thick)
    for x in (FRAME_X - 137, FRAME_X + 137):
        body += Pos(x, rod_y - 6, ram_z - 6) * Box(8, board / 2 - rod_y + 6, 12, align=front)
    return body + Pos(FRAME_X, rod_y, ram_z) * along_x(rod_d / 2, -137, 137)


def wheel(wheel, throw, start_deg, wheel_t, air, thick, pin_d, play, axle=16):
    body = FLAT * (extrude(Circle(wheel / 2) - Circle(axle / 2 + play), wheel_t))
    x, z = throw * cos(radians(start_deg)), throw * sin(radians(start_deg))
    return body + stud(x, z, pin_d / 2, -wheel_t / 2, -wheel_t - air - thick)


def block(slot, block_long, thick, pin_d, play):
    body = FLAT * extrude(Rectangle(slot - 2 * play, block_long) - Circle(pin_d / 2 + play), thick)
    return chamfer(body.edges().filter_by(Axis.Y).group_by(Axis.Z)[-1], 0.5)


def lever(lever, slot, thick, link_t, air, pin_d, play, low=40, high=140, wide=32):
    flat = SlotCenterPoint((0, lever / 2), (0, lever), 20) + Pos(0, (low + high) / 2) * Rectangle(wide, high - low + 16)
    flat -= Circle(pin_d / 2 + play) + Pos(0, (low + high) / 2) * Rectangle(slot, high - low)
    return FLAT * extrude(flat, thick) + stud(0, lever, pin_d / 2, -thick / 2, -thick - air - link_t)


def link(link, link_t, pin_d, play):
    hole = Circle(pin_d / 2 + play)
    return FLAT * extrude(Pos(link / 2, 0) * SlotCenterToCenter(link, 18) - hole - Pos(link, 0) * hole, link_t)


def ram(ram_y, rod_y, rod_d, air, link_t, pin_d, play, long=70, tall=20):
    deep = 2 * (ram_y - rod_y)
    body = Box(long, deep, tall, align=(Align.CENTER, Align.MAX, Align.CENTER))
    body = chamfer(body.edges().filter_by(Axis.Z), 1)
    body -= Pos(0, rod_y - ram_y, 0) * along_x(rod_d / 2 + play, -long, long)
    return body + stud(0, 0, pin_d / 2, link_t + air, -deep / 2 + rod_d / 2 + 1)
