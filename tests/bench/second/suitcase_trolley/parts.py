from build123d import Align, Axis, Box, Cylinder, Pos, Rot, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)
AHEAD = (Align.CENTER, Align.MIN, Align.MIN)


def along_x(radius, low, high, y=0, z=0):
    return Pos((low + high) / 2, y, z) * Rot(0, 90, 0) * Cylinder(radius, high - low)


def shell(wide, low, high, top, split, gap, deep, wall, hinge_x, hinge_d, pin_d, hinge_low, hinge_next, tube, play, tube_x, tube_y, tube_long, wheel_d, wheel_y, wheel_x, stub_d, handle_y, handle_z, rod_d, lug_x, leaf=48, pin_up=38):
    """The back half, open to the front, with hinges, the pull handle's guides, wheel brackets and lugs."""
    front = split + gap / 2
    body = Pos(0, front, low) * Box(wide, deep, high, align=AHEAD)
    body -= Pos(0, front - wall, low + wall) * Box(wide - 2 * wall, deep, high - 2 * wall, align=AHEAD)
    for x in (-tube_x, tube_x):
        body += Pos(x, tube_y, top - tube_long - 20) * Box(tube + 8, tube + 8, tube_long + 20, align=UP)
    body += Pos(0, tube_y + tube / 2 + 3, top - tube_long - 20) * Box(2 * tube_x, 10, 20, align=UP)
    for x in (-tube_x, tube_x):
        body -= Pos(x, tube_y, top - tube_long - 21) * Box(tube + 2 * play, tube + 2 * play, tube_long + 40, align=UP)
    for z in (hinge_low, hinge_low - hinge_next + 25):
        body += Pos(hinge_x, split, z) * (Cylinder(hinge_d / 2, leaf, align=UP) + Cylinder(pin_d / 2, leaf + pin_up, align=UP))
        body += Pos(hinge_x, front + 0.5, z) * Box(-hinge_x - wide / 2 + 2, hinge_d / 2 - 1, leaf, align=(Align.MIN, Align.MIN, Align.MIN))
    for side in (-1, 1):
        x = side * (wheel_x - 12)
        body += Pos(x, wheel_y, 15) * Box(14, 24, low - 15 + wall, align=UP)
        near, far = side * (wheel_x - 8), side * (wheel_x + 30)
        body += along_x(stub_d / 2, min(near, far), max(near, far), wheel_y, wheel_d / 2)
        lug = Pos(side * lug_x, handle_y, handle_z) * Rot(0, 90, 0) * Cylinder(7, 6) + Pos(side * lug_x, handle_y, top - 1) * Box(6, 14, handle_z - top + 1, align=UP)
        body += lug - Pos(side * lug_x, handle_y, handle_z) * Rot(0, 90, 0) * Cylinder(rod_d / 2 + play, 20)
    return body


def lid(wide, low, high, lid_deep, split, wall, hinge_x, hinge_d, pin_d, play, hinge_low, hinge_next, leaf=48, up=38):
    """The front half about the hinges' axis; its barrels sit on those of the shell."""
    body = Pos(-hinge_x, -split, low) * Box(wide, lid_deep, high, align=AHEAD)
    body -= Pos(-hinge_x, -split + wall, low + wall) * Box(wide - 2 * wall, 2 * lid_deep, high - 2 * wall, align=AHEAD)
    for z in (hinge_low, hinge_low - hinge_next + 25):
        one = Cylinder(hinge_d / 2, up, align=UP)
        one += Pos(0, -0.75, 0) * Box(-hinge_x - wide / 2 + 2, hinge_d / 2 - 1, up, align=(Align.MIN, Align.MAX, Align.MIN))
        body += Pos(0, 0, z + leaf + 0.4) * (one - Cylinder(pin_d / 2 + play, 3 * up))
    return body


def pull_outer(tube, tube_wall, tube_x, tube_long, bridge, gap=0.3, wide=190, deep=26):
    """Two tubes below z = 0, joined by a bridge above."""
    body = Pos(0, 0, gap) * Box(wide, deep, bridge - gap, align=UP)
    for x in (-tube_x, tube_x):
        body += Pos(x, 0, gap + 1) * Box(tube, tube, tube_long, align=DOWN)
    for x in (-tube_x, tube_x):
        body -= Pos(x, 0, bridge + 1) * Box(tube - 2 * tube_wall, tube - 2 * tube_wall, 2 * tube_long, align=DOWN)
    return body


def pull_inner(tube, tube_wall, tube_x, tube_long, play, grip=23.8, wide=190, deep=26):
    """Two rods below z = 0, the grip above."""
    body = Box(wide, deep, grip, align=UP)
    body = fillet(body.edges().filter_by(Axis.Z), 4)
    side = tube - 2 * tube_wall - 2 * play
    for x in (-tube_x, tube_x):
        body += Pos(x, 0, 1) * Box(side, side, tube_long, align=DOWN)
    return body


def wheel(wheel_d, wheel_wide, stub_d, play):
    """Along +x from its inner face."""
    tyre = fillet(along_x(wheel_d / 2, 0, wheel_wide).edges(), 3)
    return tyre - along_x(stub_d / 2 + play, -1, wheel_wide + 1)


def carry(rod_d, lug_x, reach=34, arm=9, tall=9):
    """A bow folded to the back, its rod through both lugs."""
    out = lug_x + 14
    body = along_x(rod_d / 2, -out, out) + Pos(0, reach, 0) * Box(2 * out, arm, tall)
    for side in (-1, 1):
        body += Pos(side * (out - arm / 2), reach / 2, 0) * Box(arm, reach, tall) + Pos(side * (out - arm / 2), 0, 0) * Rot(0, 90, 0) * Cylinder(tall / 2, arm)
    return body
