from build123d import Align, Axis, Box, Cylinder, Pos, Rot, chamfer, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def along_x(radius, low, high):
    return Pos(X=(low + high) / 2) * Rot(0, 90, 0) * Cylinder(radius, high - low)


def pole(pole_d, pole_high):
    rod = Cylinder(pole_d / 2, pole_high, align=UP)
    return chamfer(rod.edges(), 2)


def head(pole_d, play, cap, axis_z, pole_high, shaft_d, front, back, fin, fin_deep, wide=40, above=20):
    """A block over the pole's end at z = 0, with the shaft's bore in front and a slot for the fin behind."""
    axis = axis_z - pole_high
    block = Pos(-back, 0, -cap) * Box(front + back, wide, cap + axis + above, align=(Align.MIN, Align.CENTER, Align.MIN))
    block = fillet(block.edges().filter_by(Axis.X).group_by(Axis.Z)[-1], 8)
    block -= Cylinder(pole_d / 2 + play, 2 * cap, align=DOWN)
    block -= Pos(0, 0, axis) * along_x(shaft_d / 2 + play / 2, -6, front + 1)
    return block - Pos(-back + fin_deep, 0, axis) * Box(4 * back, fin, 200, align=(Align.MAX, Align.CENTER, Align.CENTER))


def fin(fin, long=230, high=110):
    """A board towards -x, slanted at its far end, its near end on x = 0."""
    plate = Pos(-long / 2, 0, 0) * Box(long, fin, high)
    near = plate.edges().filter_by(Axis.Y)
    plate = chamfer(near.group_by(Axis.X)[0].sort_by(Axis.Z)[0], 40)
    return plate


def rotor(across, shaft_d, hub_d=34, hub=24, shank=29, vane_wide=44, vane=3, pitch=28):
    """Shaft towards -x, six slanted vanes about the hub."""
    body = along_x(hub_d / 2, 0, hub) + along_x(shaft_d / 2, -shank, 1)
    vanes = Rot(0, 0, pitch) * Box(vane, vane_wide, across / 2 + 5, align=UP)
    disc = along_x(across / 2, -50, 50)
    for turn in range(0, 360, 60):
        body += (Rot(turn, 0, 0) * Pos(hub / 2, 0, 0) * vanes) & disc
    return body
