from build123d import Align, Axis, Box, Circle, Cylinder, Plane, Polygon, Pos, Rot, chamfer, extrude, make_hull

FORWARD = Rot(X=90)  # turns z to -y, the way the layers follow one another
UP = (Align.CENTER, Align.CENTER, Align.MIN)
CORNER = (Align.MIN, Align.MIN, Align.MIN)


def _plate(figure, thick):
    body = extrude(Plane.XZ * figure, thick / 2, both=True)
    return chamfer(body.faces().filter_by(Axis.Y).edges(), 0.5)


def _blade(eye, thick, *places):
    """A plate round eyes at places (x, z)."""
    return _plate(make_hull([edge for x, z in places for edge in (Pos(x, z) * Circle(eye)).edges()]), thick)


def _pin(x, z, layers, layer, thick, pin_d, head_d):
    """A pin from the middle of this layer through so many layers before it, a collar in each but the last, and a head before that."""
    end = thick / 2 + (layer - thick) / 2 + layers * layer
    pin = Cylinder(pin_d / 2, end, align=UP) + Pos(0, 0, end) * Cylinder(head_d / 2, 2.5, align=UP)
    if layers > 1:
        pin += Cylinder(head_d / 2, end - layer, align=UP)
    return Pos(x, 0, z) * FORWARD * pin


def _hole(x, z, pin_d, play):
    return Pos(x, 0, z) * FORWARD * Cylinder(pin_d / 2 + play, 60)


def house(foot_x, foot_z, base_x, base_z, board_y, layer, thick, pin_d, head_d, long=220, deep=120, foot=20, high=119):
    body = Box(long, deep, foot, align=CORNER) + Pos(0, board_y, 0) * Box(long, deep - board_y, high, align=CORNER)
    body = chamfer(body.edges().filter_by(Axis.X).group_by(Axis.Z)[-1], 1)
    middle = board_y + layer / 2
    body += Pos(0, middle, 0) * _pin(foot_x, foot_z, 1, layer, thick, pin_d, head_d)
    return body + Pos(0, middle, 0) * _pin(base_x, base_z, 2, layer, thick, pin_d, head_d)


def boom(tip_x, tip_z, lift_x, lift_z, crowd_x, crowd_z, eye, layer, thick, pin_d, play, head_d):
    body = _blade(eye, thick, (0, 0), (tip_x, tip_z), (lift_x, lift_z), (crowd_x, crowd_z)) - _hole(0, 0, pin_d, play)
    body += _pin(tip_x, tip_z, 1, layer, thick, pin_d, head_d) + _pin(lift_x, lift_z, 1, layer, thick, pin_d, head_d)
    return body + _pin(crowd_x, crowd_z, 2, layer, thick, pin_d, head_d)


def stick(stick, tail, ux, uz, rock_x, rock_z, curl_x, curl_z, eye, layer, thick, pin_d, play, head_d):
    x, z = stick * ux, stick * uz
    body = _blade(eye, thick, (-tail * ux, -tail * uz), (x, z), (x + rock_x, z + rock_z), (x + curl_x, z + curl_z)) - _hole(0, 0, pin_d, play)
    for px, pz, layers in ((-tail * ux, -tail * uz, 1), (x, z, 1), (x + rock_x, z + rock_z, 1), (x + curl_x, z + curl_z, 3)):
        body += _pin(px, pz, layers, layer, thick, pin_d, head_d)
    return body


def bucket(horn_x, horn_z, eye, layer, thick, pin_d, play, head_d):
    """Eyes at the origin and at the horn, and a hook-shaped blade below them."""
    figure = make_hull([*Circle(eye).edges(), *(Pos(horn_x, horn_z) * Circle(eye)).edges()])
    figure += Polygon((-8, -4), (-16, -56), (-40, -56), (-40, -80), (-12, -80), (45, -16), (40, 0), align=None)
    body = _plate(figure, thick) - _hole(0, 0, pin_d, play)
    return body + _pin(horn_x, horn_z, 1, layer, thick, pin_d, head_d)


def rocker(rocker_x, rocker_z, eye, layer, thick, pin_d, play, head_d):
    body = _blade(eye, thick, (0, 0), (rocker_x, rocker_z)) - _hole(0, 0, pin_d, play)
    pin = _pin(rocker_x, rocker_z, 2, layer, thick, pin_d, head_d)
    slim = Pos(rocker_x, -thick / 2 - (layer - thick), rocker_z) * FORWARD * (Cylinder(head_d, layer, align=UP) - Cylinder(pin_d / 2, layer, align=UP))
    return body + (pin - slim)  # no collar: the link turns there


def link(link_x, link_z, eye, thick, pin_d, play):
    return _blade(eye, thick, (0, 0), (-link_x, -link_z)) - _hole(0, 0, pin_d, play) - _hole(-link_x, -link_z, pin_d, play)


def _barrel(long, stroke, eye, thick, pin_d, play, rod_d, wide=15, bottom=13):
    """From its eye at the origin along +x, with a bore for the rod."""
    end = long - stroke / 2 - eye - 2
    body = Rot(X=90) * Cylinder(eye, thick) + Box(end, wide, thick, align=(Align.MIN, Align.CENTER, Align.CENTER)).rotate(Axis.X, 90)
    body = body - _hole(0, 0, pin_d, play)
    return body - Pos(bottom, 0, 0) * Rot(Y=90) * Cylinder(rod_d / 2 + play, end, align=UP)


def _rod(long, stroke, eye, thick, pin_d, play, rod_d, bottom=13):
    """From its eye at the origin along -x."""
    reach = long - stroke / 2 - bottom - 1
    body = Rot(X=90) * Cylinder(eye, thick) + Rot(Y=-90) * Cylinder(rod_d / 2, reach, align=UP)
    return body - _hole(0, 0, pin_d, play)


def lift_barrel(long, stroke, eye, thick, pin_d, play, rod_d):
    return _barrel(long, stroke, eye, thick, pin_d, play, rod_d)


def lift_rod(long, stroke, eye, thick, pin_d, play, rod_d):
    return _rod(long, stroke, eye, thick, pin_d, play, rod_d)


crowd_barrel = curl_barrel = lift_barrel
crowd_rod = curl_rod = lift_rod
