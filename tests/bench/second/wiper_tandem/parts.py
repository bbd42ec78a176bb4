from build123d import Align, Axis, Box, Circle, Cylinder, Plane, Pos, Rectangle, Rot, chamfer, extrude, fillet, make_hull

FORWARD = Rot(X=90)  # turns z to -y, the way the layers follow one another
BACK = Rot(X=-90)
UP = (Align.CENTER, Align.CENTER, Align.MIN)


def _strap(r, thick, *places):
    """A plate round places (x, z), its middle in y = 0."""
    figure = make_hull([edge for x, z in places for edge in (Pos(x, z) * Circle(r)).edges()])
    return extrude(Plane.XZ * figure, thick / 2, both=True)


def _hole(x, z, d):
    return Pos(x, 0, z) * FORWARD * Cylinder(d / 2, 100)


def _pin(x, z, layer, pin_d, head_d, head, way=FORWARD):
    """A pin from the middle of this layer through the next one, and a head beyond."""
    end = 1.5 * layer
    return Pos(x, 0, z) * way * (Cylinder(pin_d / 2, end, align=UP) + Pos(0, 0, end) * Cylinder(head_d / 2, head, align=UP))


def base_bar(apart, crank_x, bar_thick, bar_half, bar_left, bar_right, foot_low, foot_half, shaft_d, boss_d, play, layer, crank_z):
    """A flat bar behind y = 0 with a plate for the motor and a bush for each wiper's shaft."""
    figure = Pos((bar_left + apart + bar_right) / 2, 0) * Rectangle(apart + bar_right - bar_left, 2 * bar_half)
    figure += Pos(crank_x, foot_low / 2) * Rectangle(2 * foot_half, -foot_low)
    body = extrude(Plane.XZ * figure, -bar_thick)
    body = fillet(body.edges().filter_by(Axis.Y), 3)
    for x in (0, apart):
        body += Pos(x, 1, 0) * FORWARD * Cylinder(boss_d / 2, 1 + 2 * layer - 0.4, align=UP)
        body -= _hole(x, 0, shaft_d + 2 * play)
    return body - _hole(crank_x, crank_z, shaft_d + 2 * play)


def crank(throw, eye, thick, layer, pin_d, head_d, head, shaft_d, bar_thick):
    body = _strap(eye, thick, (0, 0), (0, throw)) + BACK * Cylinder(shaft_d / 2, layer / 2 + bar_thick, align=UP)
    return body + _pin(0, throw, layer, pin_d, head_d, head)


def drive_rod(eye, thick, pin_d, play, crank_x, p_z, l_x, l_z):
    x, z = l_x - crank_x, l_z - p_z
    body = _strap(eye, thick, (0, 0), (x, z))
    body = chamfer(body.faces().filter_by(Axis.Y).edges(), 0.5)
    return body - _hole(0, 0, pin_d + 2 * play) - _hole(x, z, pin_d + 2 * play)


def tie_rod(apart, eye, thick, pin_d, play):
    body = _strap(eye, thick, (0, 0), (apart, 0))
    body = chamfer(body.faces().filter_by(Axis.Y).edges(), 0.5)
    return body - _hole(0, 0, pin_d + 2 * play) - _hole(apart, 0, pin_d + 2 * play)


def wiper_right(l_x, l_z, arm_deg, eye, thick, layer, pin_d, head_d, head, shaft_d, bar_thick, blade, blade_start, blade_wide, depth):
    """Shaft, lever and arm in one, the blade in front of the arm."""
    body = _strap(eye, thick, (0, 0), (l_x, l_z)) + BACK * Cylinder(shaft_d / 2, 2.5 * layer + bar_thick, align=UP)
    body += _pin(l_x, l_z, layer, pin_d, head_d, head)
    middle = blade_start + blade / 2
    arm = make_hull([*Circle(eye).edges(), *(Pos(middle, 0) * Circle(5)).edges()])
    upper = extrude(Plane.XZ * arm, thick / 2, both=True)
    front = depth - bar_thick - 2.5 * layer
    rubber = Pos(middle, 1 - thick / 2, 0) * Box(blade, front - thick / 2 + 1, blade_wide, align=(Align.CENTER, Align.MAX, Align.CENTER))
    upper += chamfer(rubber.faces().sort_by(Axis.Y)[0].edges(), 0.8)
    return body + Rot(Y=-arm_deg) * upper


def wiper_left(l_x, l_z, arm_deg, eye, thick, layer, pin_d, head_d, head, shaft_d, bar_thick, blade, blade_start, blade_wide, depth):
    """As the right one, with a pin for the drive rod behind the lever."""
    body = wiper_right(l_x, l_z, arm_deg, eye, thick, layer, pin_d, head_d, head, shaft_d, bar_thick, blade, blade_start, blade_wide, depth)
    return body + _pin(l_x, l_z, layer, pin_d, head_d, head, BACK)
