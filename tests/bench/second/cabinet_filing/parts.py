from build123d import Align, Axis, Box, Cylinder, Pos, Rot, chamfer, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)
CORNER = (Align.CENTER, Align.MIN, Align.MIN)
MIDDLE = (Align.CENTER, Align.MIN, Align.CENTER)


def cabinet(wide, deep, high, foot_high, pitch, low, front_wide, front_high, air, sheet, box_half, bar_z, bar_high, play, lock_x, lock_z, key_d,
            stud_d, stud_play, foot_x, foot_front, foot_back, stop=4, side_play=0.6, nut_d=20, nut=12):
    """A sheet-metal case with three openings; a channel on each side leads each drawer's bars and ends behind the front."""
    inner = wide / 2 - sheet
    case = Pos(0, 0, foot_high) * Box(wide, deep, high, align=CORNER)
    case = fillet(case.edges().filter_by(Axis.Y), 1)
    case -= Pos(0, sheet, foot_high + sheet) * Box(2 * inner, deep - 2 * sheet, high - 2 * sheet, align=CORNER)
    edge = box_half + side_play
    for number in range(3):
        z = low + number * pitch
        case -= Pos(0, -1, z - air) * Box(front_wide + 2 * air, 2 * sheet, front_high + 2 * air, align=CORNER)
        for side in (-1, 1):
            channel = Pos(side * (edge + inner + 0.5) / 2, stop, z + bar_z)
            rail = Box(inner + 0.5 - edge, deep - stop - 10, bar_high + 2 * play + 2 * sheet, align=MIDDLE)
            rail -= Pos(0, 2 * sheet, 0) * Box(2 * wide, deep, bar_high + 2 * play, align=MIDDLE)
            case += channel * rail
    for x in (-foot_x, foot_x):
        for y in (foot_front, foot_back):
            case += Pos(x, y, foot_high) * Cylinder(nut_d / 2, nut, align=UP)
            case -= Pos(x, y, foot_high - 1) * Cylinder(stud_d / 2 + stud_play, 2 * nut, align=UP)
    return case - Pos(lock_x, 0, lock_z) * Rot(X=90) * Cylinder(key_d / 2 + 0.15, 8 * sheet)


def drawer(front_wide, front_high, sheet, box_half, bar_z, bar_high, box_low=6, box_high=190, back=470, stroke=350, stop=4, handle=25, grip=120, grip_d=6):
    """Front panel in y = 0, its lower edge in z = 0, an open box behind it, a bar at the rear of either side and a bent handle."""
    panel = Box(front_wide, 2 * sheet, front_high, align=CORNER)
    panel = chamfer(panel.faces().sort_by(Axis.Y)[0].edges(), 0.5)
    body = panel + Pos(0, sheet, box_low) * Box(2 * box_half, back - sheet, box_high, align=CORNER)
    body -= Pos(0, 2 * sheet, box_low + sheet) * Box(2 * (box_half - sheet), back - 3 * sheet, box_high, align=CORNER)
    start = stop + 2 * sheet + stroke + 1
    for side in (-1, 1):
        x = box_half - sheet / 2
        body += Pos(side * (x + front_wide / 2) / 2, start, bar_z) * Box(front_wide / 2 - x, back - start, bar_high, align=MIDDLE)
    bow = Pos(0, -handle, front_high / 2) * Box(grip, handle + sheet, 10, align=MIDDLE)
    bow = fillet(bow.edges().filter_by(Axis.Z).group_by(Axis.Y)[0], 3)
    bow -= Pos(0, grip_d - handle, front_high / 2) * Box(grip - 2 * grip_d, handle + 2 * sheet, 20, align=MIDDLE)
    return body + bow


def cam_lock(key_d, sheet, out=25.5, flange=22, key_wide=28, key_thick=3, cam=19):
    """About y: a flange before the sheet, the key's bow on it, a cam behind."""
    front = Rot(X=90)
    lock = front * Cylinder(flange / 2, 4, align=UP)
    lock = chamfer(lock.faces().sort_by(Axis.Y)[0].edges(), 1)
    lock += Pos(0, sheet + 3, 0) * front * Cylinder(key_d / 2, sheet + 5, align=UP)
    bow = Pos(0, -out, 0) * Box(key_thick, out, key_wide, align=MIDDLE)
    lock += fillet(bow.faces().sort_by(Axis.Y)[0].edges().filter_by(Axis.X), 6)
    return lock + Pos(0, sheet + 0.2, 0) * Box(20, 3, 2 * cam, align=MIDDLE)


def foot(foot_high, stud_d, disc_d=40, stud=13):
    disc = Cylinder(disc_d / 2, foot_high, align=DOWN)
    disc = chamfer(disc.edges(), 1)
    return disc + Pos(0, 0, -1) * Cylinder(stud_d / 2, stud + 1, align=UP)
