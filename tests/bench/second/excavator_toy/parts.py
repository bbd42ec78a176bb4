"""Arms lie along x in the plane y = 0; each ends in a fork for the next, whose axle is a dowel along y."""

from build123d import Align, Axis, Box, Circle, Cylinder, Pos, Rectangle, Rot, SlotCenterToCenter, chamfer, extrude, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)
AHEAD = (Align.MIN, Align.CENTER, Align.CENTER)


def along_y(radius, long):
    return Rot(90, 0, 0) * Cylinder(radius, long)


def upright(flat, thick):
    return Rot(90, 0, 0) * extrude(flat, thick / 2, both=True)


def fork(x, back, jaw, lug, radius, pin):
    """Two cheeks about an axle at x, joined at `back` before it."""
    cheeks = upright(Pos(x - back / 2, 0) * Rectangle(back, 2 * radius) + Pos(x, 0) * Circle(radius), jaw + 2 * lug)
    cheeks -= Pos(x - back + 12, 0, 0) * Box(80, jaw, 60, align=AHEAD)
    return cheeks - Pos(x, 0, 0) * along_y(pin / 2, 100)


def crawler(track_h, deck, pin, blade_x, blade_z, lug):
    body = Pos(0, 0, 10) * Box(110, 60, deck - 12, align=UP)
    for side in (-1, 1):
        track = Pos(0, side * 42, track_h / 2) * upright(SlotCenterToCenter(120, track_h), 26)
        body += chamfer(track.edges().group_by(Axis.Y)[-1 if side > 0 else 0], 2)
        arm = Pos(blade_x, side * 22, blade_z) * upright(Pos(20, 0) * Rectangle(40, 16) + Circle(8), lug)
        body += arm - Pos(blade_x, 0, blade_z) * along_y(pin / 2, 100)
    post = Pos(0, 0, deck - 4) * Cylinder(10, 22, align=UP)
    return body + Pos(0, 0, deck - 4) * Cylinder(30, 3.6, align=UP) + chamfer(post.edges().group_by(Axis.Z)[-1], 1)


def cab(deck, cab_w, boom_x, boom_z, jaw, lug, pin):
    body = Pos(-8, 0, 0) * Box(96, cab_w, 14, align=UP)
    body = fillet(body.edges().filter_by(Axis.Z), 8)
    house = Pos(-24, 0, 0) * Box(60, cab_w - 6, 64, align=UP)
    body += fillet(house.edges().filter_by(Axis.Y).group_by(Axis.Z)[-1], 8)
    mast = Pos(boom_x, 0, boom_z - deck) * fork(0, 34, jaw, lug, 9, pin)
    mast += Pos(boom_x - 34, 0, 0) * Box(21, jaw + 2 * lug, boom_z - deck, align=(Align.MIN, Align.CENTER, Align.MIN))
    body += mast
    return body - Cylinder(10.3, 19, align=UP)


def boom(boom, beam, jaw, lug, pin, play):
    body = upright(Pos((boom - 30) / 2, 0) * Rectangle(boom - 30, 18) + Circle(9), beam)
    body += fork(boom, 34, jaw, lug, 9, pin)
    return body - along_y(pin / 2 + play, 100)


def stick(stick, beam, jaw, lug, pin, play):
    body = upright(Pos((stick - 30) / 2, 0) * Rectangle(stick - 30, 16) + Circle(8), beam)
    body += fork(stick, 34, jaw, lug, 8, pin)
    return body - along_y(pin / 2 + play, 100)


def bucket(beam, pin, play, wide=52):
    """A lug about the axle, a scoop below it that opens to +z."""
    body = upright(Pos(11, 0) * Rectangle(22, 16) + Circle(8), beam) - along_y(pin / 2 + play, 100)
    scoop = Pos(20, 0, 2) * Box(42, wide, 36, align=AHEAD)
    scoop = fillet(scoop.edges().filter_by(Axis.Y).group_by(Axis.Z)[0], 8)
    return body + (scoop - Pos(26, 0, 10) * Box(30, wide - 12, 40, align=AHEAD))


def blade(pin, play, lug):
    body = along_y(8, 37) + Pos(-8, 0, 0) * Box(20, 37, 14)
    plate = Pos(-22, 0, -1) * Box(10, 100, 40)
    body += chamfer(plate.edges().filter_by(Axis.Y).group_by(Axis.X)[0], 2)
    return body - along_y(pin / 2 + play, 200)


def pin(long, pin):
    body = along_y(pin / 2, long)
    return chamfer(body.edges(), 0.5)
