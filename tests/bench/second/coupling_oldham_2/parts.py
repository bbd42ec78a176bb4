from build123d import Align, Axis, Box, Cylinder, Pos, Rot, chamfer

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def base(offset, block_x, shaft_d, play, long=140, wide=60, plate=10, floor=-45, block=24, top=18):
    """A plate with two blocks, one bored off the middle."""
    body = Pos(0, 0, floor) * Box(long, wide, plate, align=UP)
    for x, y in ((-block_x, 0), (block_x, offset)):
        body += Pos(x, 0, floor) * Box(block, wide, top - floor, align=UP)
        body -= Pos(x, y, 0) * Rot(Y=90) * Cylinder(shaft_d / 2 + play, 2 * block)
    return body


def along_x(start, end, radius):
    return Pos(start, 0, 0) * Rot(Y=90) * Cylinder(radius, end - start, align=UP)


def hub_left(shaft_d, across, face, tongue, tongue_wide, hub=20, end=66):
    """Towards -x, its tongue along z."""
    body = along_x(-face - hub, -face, across / 2) + along_x(-end, -face - hub / 2, shaft_d / 2)
    body = chamfer(body.edges().group_by(Axis.X)[0], 1)
    bar = Pos(-face + (tongue - 1) / 2, 0, 0) * Box(tongue + 1, tongue_wide, across)
    return body + (bar & along_x(-across, across, across / 2))


def hub_right(shaft_d, across, face, tongue, tongue_wide, hub=20, end=66):
    """Towards +x, its tongue along y."""
    body = along_x(face, face + hub, across / 2) + along_x(face + hub / 2, end, shaft_d / 2)
    body = chamfer(body.edges().group_by(Axis.X)[-1], 1)
    bar = Pos(face - (tongue - 1) / 2, 0, 0) * Box(tongue + 1, across, tongue_wide)
    return body + (bar & along_x(-across, across, across / 2))


def floater(across, face, tongue, tongue_wide, side, air):
    """Disc with a slot along z at -x and one along y at +x."""
    half, slot = face - air, tongue_wide + 2 * side
    bottom = face - tongue - air
    body = along_x(-half, half, across / 2)
    body -= Pos(-bottom, 0, 0) * Box(2 * half, slot, 2 * across, align=(Align.MAX, Align.CENTER, Align.CENTER))
    return body - Pos(bottom, 0, 0) * Box(2 * half, 2 * across, slot, align=(Align.MIN, Align.CENTER, Align.CENTER))
