from build123d import Align, Circle, Cylinder, GridLocations, Pos, Rectangle, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def _posts(post_d, post_x, post_y):
    return GridLocations(2 * post_x, 2 * post_y, 2, 2) * Circle(post_d / 2)


def top(long, wide, thick, post_d, post_x, post_y, blind, holes_pitch, hole=16.5):
    """On z = 0; the sockets of the posts open below."""
    plate = Rectangle(long, wide) - GridLocations(holes_pitch, 1, 6, 1) * Circle(hole / 2)
    return extrude(plate - _posts(post_d, post_x, post_y), blind) + Pos(0, 0, blind) * extrude(plate, thick - blind)


def base(long, wide, thick, post_d, post_x, post_y, socket, holes_pitch, dimple=12, dimple_deep=4):
    """Its upper face is z = 0."""
    plate, row = Rectangle(long, wide), GridLocations(holes_pitch, 1, 6, 1) * Circle(dimple / 2)
    bored = plate - _posts(post_d, post_x, post_y)
    body = extrude(bored - row, -dimple_deep) + Pos(0, 0, -dimple_deep) * extrude(bored, dimple_deep - socket)
    return body + Pos(0, 0, -socket) * extrude(plate, socket - thick)


def post(post_d, clear, socket, blind):
    return Cylinder(post_d / 2, socket + clear + blind, align=UP)
