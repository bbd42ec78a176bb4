"""Shafts along x; the input's fork opens to +x, its prongs lie above and below the cross at the origin."""

from build123d import Align, Axis, Box, Cylinder, Pos, Rot, chamfer, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def along_x(radius, low, high):
    return Pos(X=(low + high) / 2) * Rot(0, 90, 0) * Cylinder(radius, high - low)


def fork(tip, outer, inner, pin_d, play, throat, bridge):
    """Open towards +x, prongs at both sides of z = 0."""
    body = Pos(-bridge / 2, 0, 0) * Box(bridge, 2 * tip, 2 * outer) + Cylinder(tip, 2 * outer)
    body -= Pos(-throat, 0, 0) * Box(2 * throat, 4 * tip, 2 * inner, align=(Align.MIN, Align.CENTER, Align.CENTER))
    return body - Cylinder(pin_d / 2 + play, 4 * outer)


def input(tip, outer, inner, pin_d, play, shaft, throat, bridge, reach):
    rod = along_x(shaft / 2, -reach, -bridge + 5)
    rod = chamfer(rod.edges().group_by(Axis.X)[0], 1)
    return fork(tip, outer, inner, pin_d, play, throat, bridge) + (rod - Pos(-throat, 0, 0) * Box(2 * throat, 40, 2 * inner, align=(Align.MIN, Align.CENTER, Align.CENTER)))


output = input


def middle(length, tip, outer, inner, pin_d, play, shaft, throat, bridge):
    eye = Rot(90, 0, 0) * fork(tip, outer, inner, pin_d, play, throat, bridge)
    return Rot(0, 0, 180) * eye + Pos(X=length) * eye + along_x(shaft / 2, bridge - 5, length - bridge + 5)


def cross(inner, outer, pin_d):
    """A cube with shoulders between the prongs, and four journals."""
    body = fillet(Box(10, 10, 10).edges(), 1.5)
    for turn in (Rot(), Rot(90, 0, 0)):
        journal = Cylinder(pin_d / 2, 2 * outer)
        body += turn * chamfer(journal.edges(), 0.5) + turn * Cylinder(pin_d / 2 + 1, 2 * inner - 0.4)
    return body


cross_in = cross_out = cross


def base(ex, ey, post_at, axis_z, shaft, play, plate=12, high=80, post=18):
    long = ex + 155
    body = Pos(ex / 2, ey / 2, 0) * Box(long, ey + 80, plate, align=UP)
    body = chamfer(body.edges().filter_by(Axis.Z), 5)
    for x, y in ((-post_at, 0), (ex + post_at, ey)):
        column = Pos(x, y, plate / 2) * Box(post, 40, high - plate / 2, align=UP)
        body += chamfer(column.edges().filter_by(Axis.X).group_by(Axis.Z)[-1], 4)
        body -= Pos(x, y, axis_z) * along_x(shaft / 2 + play, -post, post)
    return body
