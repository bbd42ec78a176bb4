"""Left parts are drawn. All flat parts lie in XZ, their back face at y = 0; pins point to the front."""

from build123d import Align, Axis, Box, Circle, Cylinder, Pos, Rectangle, Rot, SlotCenterPoint, chamfer, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)
FLAT = Rot(90, 0, 0)


def stud(x, z, radius, back, front):
    body = Pos(x, back, z) * FLAT * Cylinder(radius, back - front, align=UP)
    return chamfer(body.edges().group_by(Axis.Y)[0], 0.5)


def palm(pitch_r, geared_z, step_x, step_z, thick, air, pin_d, plate=8, wide=130, low=11, high=80, flange=60):
    body = Cylinder(flange / 2, 12, align=UP)
    board = Pos(0, 0, low) * Box(wide, plate, high - low, align=(Align.CENTER, Align.MIN, Align.MIN))
    body += chamfer(board.edges().filter_by(Axis.Y), 3)
    for side in (-1, 1):
        for x, z in ((pitch_r, geared_z), (pitch_r + step_x, geared_z - step_z)):
            body += stud(side * x, z, pin_d / 2, plate / 2, -air - thick)
    return body


def bar(arm, wide, foot, thick, layer, pin_d, play):
    flat = SlotCenterPoint((0, arm / 2), (0, arm), wide) + Circle(foot) - Circle(pin_d / 2 + play)
    return FLAT * extrude(flat, thick) + stud(0, arm, pin_d / 2, -thick / 2, -thick - layer)


def geared(arm, wide, pitch_r, thick, layer, pin_d, play):
    return bar(arm, wide, pitch_r - 0.1, thick, layer, pin_d, play)


def idle(arm, wide, thick, layer, pin_d, play):
    return bar(arm, wide, wide / 2, thick, layer, pin_d, play)


def finger(step_x, step_z, wide, thick, pin_d, play, blade=16, reach=90):
    """The left finger: its lever goes out to the left, its blade up on the pin's inner side."""
    flat = SlotCenterPoint((-step_x / 2, -step_z / 2), (-step_x, -step_z), wide)
    flat += Pos(-2, reach / 2) * Rectangle(blade, reach)
    hole = Circle(pin_d / 2 + play)
    return FLAT * extrude(flat - hole - Pos(-step_x, -step_z) * hole, thick)
