from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.MIN, Align.MIN, Align.MIN)


def block(x0, x1, y0, y1, z0, z1):
    return Pos(x0, y0, z0) * Box(x1 - x0, y1 - y0, z1 - z0, align=LOW)


def body(
    long, deep, high, wall, play, knob_y, knob_z, button_z, floor=3, slot_from=70, slot_long=140, slot_wide=30, slot_y=30, boss=5, shaft=8
):
    mid = deep / 2
    shell = block(0, long, 0, deep, 0, high) - block(wall, long - wall, wall, deep - wall, floor, high - wall)
    inside = long - wall
    # C-shaped guide of the carriage's flange, behind the slot of the lever
    for side in (-1, 1):
        y = sorted((mid + side * (15 + play), mid + side * 20))
        shell += block(inside - 11, inside, *y, 40, high - wall)
        y = sorted((mid + side * 7, mid + side * 20))
        shell += block(inside - 11, inside - 8, *y, 40, high - wall)
    shell -= block(inside - 1, long + 1, mid - 5.5, mid + 5.5, 50, 150)
    # slots for the bread
    for side in (-1, 1):
        middle = mid + side * slot_y
        shell -= block(slot_from, slot_from + slot_long, middle - slot_wide / 2, middle + slot_wide / 2, high - 2 * wall, high + 1)
    # guides of the crumb tray: two rails with lips over its edges, and its opening
    for side in (-1, 1):
        y = sorted((mid + side * (60 + play), mid + side * (mid - wall / 2)))
        shell += block(wall / 2, long - 10, *y, floor, 14)
        y = sorted((mid + side * 54, mid + side * (mid - wall / 2)))
        shell += block(wall / 2, long - 10, *y, 10 + play, 14)
    shell -= block(-1, wall + 1, mid - 60 - play, mid + 60 + play, floor, 10 + play)
    # bearings of knob and button
    for z in (knob_z, button_z):
        shell += Pos(long - wall / 2, knob_y, z) * Rot(Y=-90) * Cylinder(8, boss + wall / 2, align=(Align.CENTER, Align.CENTER, Align.MIN))
        shell -= Pos(long, knob_y, z) * Rot(Y=90) * Cylinder(shaft / 2 + 0.2, 60)
    return shell
