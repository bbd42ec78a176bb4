from build123d import Align, Axis, Box, Cylinder, Pos, Rot, fillet

CORNER = (Align.MIN, Align.MIN, Align.MIN)
BETWEEN = (Align.CENTER, Align.MIN, Align.MIN)


def along_x(radius, low, high):
    return Pos(X=(low + high) / 2) * Rot(0, 90, 0) * Cylinder(radius, high - low)


def tray(long, lug, pitch, deep, tall, axis_y, axis_z, pin_d, play, wall=1.6, floor=1.6, lug_low=18, lug_back=4, lug_up=3):
    """Seven cells, open above; behind them eight lugs with bores."""
    body = Pos(lug / 2, 0, 0) * Box(long - lug, deep, tall, align=CORNER)
    for day in range(7):
        body -= Pos(lug / 2 + (day + 0.5) * pitch, wall, floor) * Box(pitch - wall, deep - 2 * wall, tall, align=BETWEEN)
    for day in range(8):
        body += Pos(lug / 2 + day * pitch, deep - wall / 2, lug_low) * Box(lug, axis_y + lug_back - deep + wall / 2, tall - lug_low, align=BETWEEN)
        body += Pos(lug / 2 + day * pitch, axis_y - lug_back, lug_low) * Box(lug, 2 * lug_back, axis_z + lug_up - lug_low, align=BETWEEN)
    return body - Pos(0, axis_y, axis_z) * along_x(pin_d / 2 + play, -1, long + 1)


def lid(pitch, lug, barrel_d, pin_d, side, lid_wide, axis_y, over, thick=2, low=-1.9, near=6):
    """About its hinge's middle, the panel towards -y; a pin at either end of the barrel."""
    barrel = pitch - lug - 2 * side
    panel = Pos(0, -axis_y - over, low) * Box(lid_wide, axis_y + over - near, thick, align=BETWEEN)
    panel = fillet(panel.edges().filter_by(Axis.Z).group_by(Axis.Y)[0], 1.5)
    body = panel + Pos(0, -near - 1, low) * Box(barrel, near + 1, thick, align=BETWEEN)
    return body + along_x(barrel_d / 2, -barrel / 2, barrel / 2) + along_x(pin_d / 2, -lid_wide / 2, lid_wide / 2)
