from build123d import Align, Axis, Box, Cylinder, Plane, Polygon, Pos, Rectangle, Rot, chamfer, extrude, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = Rot(X=90)  # turns z to -y


def post(post_side, post_wall, base_thick, post_top, collar_d, collar, pivot_z, shaft_d, base_side=460):
    """A square tube on its base plate, with a collar in front that holds the shaft."""
    plate = Box(base_side, base_side, base_thick, align=UP)
    body = chamfer(plate.edges().group_by(Axis.Z)[-1], 1)
    tube = Box(post_side, post_side, post_top, align=UP)
    body += fillet(tube.edges().filter_by(Axis.Z), 1)
    inner = post_side - 2 * post_wall
    body -= Pos(0, 0, base_thick) * Box(inner, inner, post_top, align=UP)
    body += Pos(0, 2 * post_wall - post_side / 2, pivot_z) * FRONT * Cylinder(collar_d / 2, collar + 2 * post_wall, align=UP)
    return body - Pos(0, 0, pivot_z) * FRONT * Cylinder(shaft_d / 2, post_side, align=UP)


def cap(post_side, post_wall, cap_thick, side=360, lip=12):
    """A lid whose lip lies inside the tube."""
    body = Box(side, side, cap_thick, align=UP)
    body = chamfer(body.edges().group_by(Axis.Z)[-1], 1)
    inner = post_side - 2 * post_wall - 1
    return body + Pos(0, 0, -lip) * (Box(inner, inner, lip + 1, align=UP) - Box(inner - 16, inner - 16, lip, align=UP))


def shaft(boom_y, shaft_end, shaft_d, post_side, post_wall):
    """Along y, from inside the post to the washer."""
    start = 2 * post_wall - post_side / 2
    return Pos(0, start - boom_y, 0) * FRONT * Cylinder(shaft_d / 2, start - shaft_end, align=UP)


def washer(washer_thick, across=102):
    body = FRONT * Cylinder(across / 2, washer_thick, align=UP)
    return chamfer(body.edges(), 1)


def _blade(start, tip, root, end, wide, inset):
    """A bar, level to the pivot at x = 0 and tapered to the tip; `inset` makes it smaller all round."""
    a, b = root / 2 - inset, end / 2 - inset
    face = Polygon((start + inset, -a), (0, -a), (tip - inset, -b), (tip - inset, b), (0, a), (start + inset, a), align=None)
    return extrude(Plane.XZ * face, wide / 2 - inset, both=True)


def boom(tip, weight_end, weight_long, root, boom_wide, hub_d, hub, shaft_d, play, end=80, sheet=5):
    start = weight_long - weight_end
    body = _blade(start, tip, root, end, boom_wide, 0)
    body = chamfer(body.faces().sort_by(Axis.X)[-1].edges(), 1)
    body -= _blade(start, tip, root, end, boom_wide, sheet)
    body -= [Pos(x, 0, 0) * Cylinder(5, root, align=(Align.CENTER, Align.CENTER, Align.MAX)) for x in (start + 30, hub_d, tip - 60)]  # drain the hollows
    drum = FRONT * Cylinder(hub_d / 2, hub)
    body += chamfer(drum.edges(), 1)
    return body - FRONT * Cylinder(shaft_d / 2 + play, 4 * hub)


def counterweight(weight_long, wide=98, tall=222):
    body = Box(weight_long, wide, tall, align=(Align.MAX, Align.CENTER, Align.CENTER))
    return fillet(body.edges().filter_by(Axis.Y), 1)
