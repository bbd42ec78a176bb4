from build123d import Align, Axis, Box, Circle, Cylinder, Plane, Pos, Rectangle, Rot, chamfer, extrude, fillet

ON_FLOOR = (Align.CENTER, Align.CENTER, Align.MIN)


def bottom(long, deep, board, thick=18):
    """Lies between the four walls, its upper face in z = 0."""
    return Box(long - 2 * board, deep - 2 * board, thick, align=(Align.CENTER, Align.CENTER, Align.MAX))


def front_board(wide, tall, board):
    return Box(wide, board, tall, align=ON_FLOOR)


back_board = front_board


def _side(deep, high, lid_thick, board, pin_d, play, head_d, head):
    """From y = 0 to the back, where a rounded ear bears the pin; `head` counterbores it from -x."""
    r = lid_thick / 2
    face = Pos(deep / 2, (high - lid_thick) / 2) * Rectangle(deep, high - lid_thick)
    face += Pos(deep - r, high - lid_thick) * Rectangle(lid_thick, lid_thick) + Pos(deep - r, high - r) * Circle(r)
    wall = extrude(Plane.YZ * face, board / 2, both=True)
    wall -= Pos(0, deep - r, high - r) * Rot(Y=90) * Cylinder(pin_d / 2 + play / 2, 2 * board)
    if head:
        wall -= Pos(-board / 2, deep - r, high - r) * Rot(Y=90) * Cylinder(head_d / 2, head, align=ON_FLOOR)
    foot = Pos(0, deep / 2, 0) * Box(2 * board, deep - 160, 40)  # leaves two feet
    wall -= foot
    return wall


def side_l(deep, high, lid_thick, board, pin_d, play, head_d=14, head=5):
    return _side(deep, high, lid_thick, board, pin_d, play, head_d, head)


def side_r(deep, high, lid_thick, board, pin_d, play):
    return _side(deep, high, lid_thick, board, pin_d, play, 0, 0)


def lid(long, deep, lid_thick, board, pin_d, play, air=0.5, ear_air=3):
    """Board of the whole width, narrower between the ears; round about the pin's axis, which is x through the origin."""
    r, inner = lid_thick / 2, long - 2 * board - 2 * air
    front = deep - lid_thick / 2
    body = Pos(0, -front, 0) * Box(long, front - r - ear_air, lid_thick, align=(Align.CENTER, Align.MIN, Align.CENTER))
    body += Pos(0, -r - ear_air, 0) * Box(inner, r + ear_air, lid_thick, align=(Align.CENTER, Align.MIN, Align.CENTER))
    body += Rot(Y=90) * Cylinder(r, inner)
    edges = [*body.faces().sort_by(Axis.Y)[0].edges().filter_by(Axis.Z), *body.faces().sort_by(Axis.Y)[0].edges().filter_by(Axis.X)]
    body = chamfer(edges, 1)
    return body - Rot(Y=90) * Cylinder(pin_d / 2 + play, 2 * long)


def pin(long, pin_d, head_d=13.5, head=5, short=2):
    """About x, from the head's outer face at the origin."""
    rod = Rot(Y=90) * Cylinder(pin_d / 2, long - short, align=ON_FLOOR) + Rot(Y=90) * Cylinder(head_d / 2, head, align=ON_FLOOR)
    return chamfer(rod.faces().sort_by(Axis.X)[-1].edges(), 1)
