from build123d import Align, Axis, Box, Cylinder, Pos, Rot, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def along_y(start, end, radius):
    return Pos(0, start, 0) * Rot(X=-90) * Cylinder(radius, end - start, align=UP)


def table(pitch, inner, wall, rod_z, rod_d, play, bottom, score, wall_high, rail_z, rail_d, marker, goal=110):
    """An open box with bores for the rods, a goal in each end and a rail on each long wall."""
    long = 6 * pitch + 20
    body = Box(long + 2 * wall, inner + 2 * wall, wall_high, align=UP)
    body -= Pos(0, 0, bottom) * Box(long, inner, wall_high, align=UP)
    body -= Pos(0, 0, bottom) * Box(2 * long, goal, 45, align=UP)
    for i in range(6):
        body -= Pos((2 * i - 5) * pitch / 2, 0, rod_z) * along_y(-inner, inner, rod_d / 2 + play)
    end = (score + marker) / 2 + 5
    for side in (-1, 1):
        y = side * (inner + wall) / 2
        for x in (-end, end):
            body += Pos(x, y, wall_high - 1) * Box(8, 8, rail_z - wall_high + 6, align=UP)
        body += Pos(-end, y, rail_z) * Rot(Y=90) * Cylinder(rail_d / 2, 2 * end, align=UP)
    return body


def rod(stroke, inner, wall, rod_d, rod_z, bottom, apart=90, ring_d=18, ring=8, grip_d=26, grip=80):
    """Along y, its handle at -y; the players hang down."""
    stop = inner / 2 - stroke / 2 - 0.5
    near = inner / 2 + wall + stroke / 2 + 4
    body = along_y(-near - grip, near, rod_d / 2) + along_y(-near - grip, -near, grip_d / 2)
    body = fillet(body.edges().group_by(Axis.Y)[0], 4)
    for side in (-1, 1):
        body += along_y(side * stop - (ring if side > 0 else 0), side * stop + (ring if side < 0 else 0), ring_d / 2)
        body += Pos(0, side * apart / 2, 0) * player(rod_z - bottom - 6, rod_d)
    return body


def player(down, rod_d, wide=22, thick=12):
    """Body, head and foot about a rod along y."""
    figure = Pos(0, 0, -down / 2 + 4) * Box(thick, wide, down - 8 + 14)
    figure += Pos(0, 0, 13) * Cylinder(7, 16) + Pos(0, 0, -down) * Box(thick + 6, wide - 4, 14, align=UP)
    return figure + along_y(-wide / 2 - 2, wide / 2 + 2, rod_d / 2 + 3)


def marker(rail_d, play, marker, across=18):
    """A bead; the rail goes through it along x, its left end is at the left stop."""
    bead = Rot(Y=90) * Cylinder(across / 2, marker)
    return fillet(bead.edges(), 2) - Rot(Y=90) * Cylinder(rail_d / 2 + play, 2 * marker)
