from build123d import Align, Axis, Box, Circle, Cylinder, Plane, Pos, Rot, chamfer, extrude, make_hull

FORWARD = Rot(X=90)  # turns z to -y, the way the layers follow one another
UP = (Align.CENTER, Align.CENTER, Align.MIN)


def _blade(eye, thick, *places):
    """A plate with rounded corners at places (x, z), its middle in y = 0."""
    figure = make_hull([edge for x, z in places for edge in (Pos(x, z) * Circle(eye)).edges()])
    body = extrude(Plane.XZ * figure, thick / 2, both=True)
    return chamfer(body.faces().filter_by(Axis.Y).edges(), 0.5)


def _hole(x, z, pin_d, play):
    return Pos(x, 0, z) * FORWARD * Cylinder(pin_d / 2 + play, 60)


def _pin(x, z, layers, layer, pin_d, head_d, head):
    """A pin from the middle of this layer through so many layers before it, and a head before the last."""
    end = layer / 2 + layers * layer
    return Pos(x, 0, z) * FORWARD * (Cylinder(pin_d / 2, end, align=UP) + Pos(0, 0, end) * Cylinder(head_d / 2, head, align=UP))


def stand(axis_z, pb_x, pb_z, layer, thick, pin_d, head_d, head, board, play, shaft_d=10, left=-100, right=40, foot=14, front=60, back=80):
    """An upright board with a bore for the crank's shaft and a pin for the hip, on a foot."""
    plate = _blade(18, board, (0, 0), (pb_x, pb_z), (left + 18, foot + 8 - axis_z), (right - 18, foot + 8 - axis_z))
    body = Pos(0, board / 2, axis_z) * plate
    base = Pos((left + right) / 2, (back - front) / 2, 0) * Box(right - left + 60, back + front, foot, align=UP)
    body += chamfer(base.edges().group_by(Axis.Z)[-1], 1)
    body += Pos(left / 2 + right / 2, board / 2, foot / 2) * Box(right - left - 30, board - 1, foot + 20, align=UP)
    body -= Pos(0, 0, axis_z) * FORWARD * Cylinder(shaft_d / 2 + play, 200)
    end = 2 * layer - (layer - thick) / 2  # flush with the inner link, whose counterbore holds the head
    hip = Pos(0, 0, -1) * Cylinder(pin_d / 2, end + 1, align=UP) + Pos(0, 0, end - head) * Cylinder(head_d / 2, head, align=UP)
    return body + Pos(pb_x, 0, pb_z + axis_z) * FORWARD * hip


def crank(x1, z1, eye, thick, layer, pin_d, head_d, head, board, shaft_d=10, knob_d=30, knob=14):
    """A shaft through the board with a knob behind it; the pin carries both long bars."""
    body = _blade(eye, thick, (0, 0), (x1, z1))
    body += Rot(X=-90) * Cylinder(shaft_d / 2, layer / 2 + board + 2, align=UP)
    grip = Pos(0, layer / 2 + board + 0.5, 0) * Rot(X=-90) * Cylinder(knob_d / 2, knob, align=UP)
    body += chamfer(grip.edges(), 1)
    return body + _pin(x1, z1, 2, layer, pin_d, head_d, head)


def upper_bar(x1, z1, eye, thick, pin_d, play):
    return _blade(eye, thick, (0, 0), (x1, z1)) - _hole(0, 0, pin_d, play) - _hole(x1, z1, pin_d, play)


lower_bar = outer_link = upper_bar


def inner_link(x1, z1, eye, thick, pin_d, play, head_d, head):
    """From the hip, counterbored for the pin's head, to the knee."""
    body = upper_bar(x1, z1, eye, thick, pin_d, play)
    return body - Pos(0, -thick / 2, 0) * Rot(X=-90) * Cylinder(head_d / 2 + 2 * play, head + play, align=UP)


def shoulder(x1, z1, x2, z2, eye, thick, layer, pin_d, play, head_d, head):
    body = _blade(eye, thick, (0, 0), (x1, z1), (x2, z2)) - _hole(0, 0, pin_d, play)
    return body + _pin(x1, z1, 1, layer, pin_d, head_d, head) + _pin(x2, z2, 1, layer, pin_d, head_d, head)


def foot(x1, z1, x2, z2, eye, thick, layer, pin_d, head_d, head):
    """The knee at the origin, the heel and the toe."""
    body = _blade(eye, thick, (0, 0), (x1, z1), (x2, z2))
    return body + _pin(0, 0, 2, layer, pin_d, head_d, head) + _pin(x1, z1, 1, layer, pin_d, head_d, head)
