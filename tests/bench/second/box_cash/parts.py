from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.MIN, Align.MIN, Align.MIN)
UP = (Align.CENTER, Align.CENTER, Align.MIN)
X, Y = Rot(Y=90), Rot(X=90)


def block(x, y, z):
    """Return a box between two values of each coordinate."""
    return Pos(x[0], y[0], z[0]) * Box(x[1] - x[0], y[1] - y[0], z[1] - z[0], align=LOW)


def box(wide, deep, tall, wall, hinge_y, hinge_z, ear_x, ear, eye_d, rod_d, play, tray_z, lock_z, lock_d, ledge=8, lug=15):
    """Sheet box with a ledge for the tray along both ends and two lugs behind."""
    half = wide / 2
    body = block((-half, half), (0, deep), (0, tall)) - block((wall - half, half - wall), (wall, deep - wall), (wall, 2 * tall))
    for side in (-1, 1):
        x = sorted((side * (half - wall - ledge), side * (half - wall / 2)))
        body += block(x, (wall / 2, deep - wall / 2), (tray_z - wall, tray_z))
        x = sorted((side * ear_x, side * (ear_x + ear)))
        lugs = block(x, (deep - wall / 2, hinge_y + eye_d / 2), (tall - lug, hinge_z)) - block(x, (0, hinge_y + 20), (tall, hinge_z))
        body += lugs + block(x, (hinge_y - eye_d / 2, hinge_y + eye_d / 2), (tall - lug, hinge_z))
        body += Pos(side * (ear_x + ear / 2), hinge_y, hinge_z) * X * Cylinder(eye_d / 2, ear)
    body -= Pos(0, hinge_y, hinge_z) * X * Cylinder(rod_d / 2 + play, 2 * wide)
    return body - Pos(0, 0, lock_z) * Y * Cylinder(lock_d / 2 + play, 4 * wall)


def lid(wide, deep, wall, hinge_y, ear_x, ear, rod_d, lid_front, lid_low, lid_top, grip_y, grip_z, grip_x, stud_d, play, stay=6):
    """Shut, about the hinge: a shallow lid, its hinge rod behind, two ears for the handle above."""
    half, back = wide / 2, deep - hinge_y
    body = block((-half, half), (-lid_front, back), (lid_low, lid_top))
    body -= block((wall - half, half - wall), (wall - lid_front, back - wall), (lid_low - 1, lid_top - wall))
    body += block((1 - ear_x, ear_x - 1), (back - wall / 2, 0), (-1.4, 1.4)) + X * Cylinder(3, 2 * ear_x - 2)
    body += X * Cylinder(rod_d / 2, 2 * (ear_x + ear))
    for side in (-1, 1):
        x = sorted((side * grip_x, side * (grip_x + stay)))
        body += block(x, (grip_y - 6, grip_y + 6), (lid_top - wall / 2, grip_z)) + Pos(side * (grip_x + stay / 2), grip_y, grip_z) * X * Cylinder(6, stay)
    return body - Pos(0, grip_y, grip_z) * X * Cylinder(stud_d / 2 + play, 3 * grip_x)


def handle(grip_x, stud_d, reach=36, bar=7, stay=6, gap=0.5):
    """Flat towards -y, with a stud at each end."""
    inner = grip_x - gap
    body = Pos(0, -reach, 0) * X * Cylinder(bar / 2, 2 * inner)
    for side in (-1, 1):
        x = sorted((side * inner, side * (inner - bar)))
        body += block(x, (-reach, 0), (-bar / 2, bar / 2)) + Pos(side * (inner - bar / 2), 0, 0) * X * Cylinder(bar / 2, bar)
        body += Pos(side * (inner + stay / 2), 0, 0) * X * Cylinder(stud_d / 2, stay + 2 * gap)
    return body


def tray(wall, long=294, wide=224, high=40):
    """Six cells, three by two."""
    body = Box(long, wide, high, align=UP)
    x, y = (long - 4 * wall) / 3, (wide - 3 * wall) / 2
    for i in (-1, 0, 1):
        for j in (-0.5, 0.5):
            body -= Pos(i * (x + wall), j * (y + wall), wall) * Box(x, y, high, align=UP)
    return body


def key(lock_d, wall, key_out, gap=0.3, collar_d=17, collar=3.5, bow_wide=3, bow_high=26):
    """Cylinder through the front wall, collar and cam on either side, the key in it upright."""
    body = Pos(0, wall / 2, 0) * Y * Cylinder(lock_d / 2, wall + 2 * gap + 2)
    body += Pos(0, -gap - collar / 2, 0) * Y * Cylinder(collar_d / 2, collar) + Pos(0, wall + gap + 2, 0) * Y * Cylinder(collar_d / 2, 4)
    body += block((-4, 4), (wall + gap, wall + gap + 4), (0, 14))
    return body + block((-bow_wide / 2, bow_wide / 2), (-key_out, -gap - 1), (-bow_high / 2, bow_high / 2))
