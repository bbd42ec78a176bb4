from build123d import Align, Axis, Box, Circle, Cylinder, Plane, Pos, Rectangle, Rot, chamfer, extrude, loft

UP = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = Rot(90, 0, 0)


def frustum(low, high, z_low, z_high):
    return loft([Plane.XY.offset(z_low) * Rectangle(low, low), Plane.XY.offset(z_high) * Rectangle(high, high)])


def along_x(radius, low, high):
    return Pos(X=(low + high) / 2) * Rot(0, 90, 0) * Cylinder(radius, high - low)


def case(foot, head, tall, wall, pivot_y, pivot_z, stud_d, key_x, key_z, key_d, play, rod_thick):
    """A hollow pyramid, open below, with the pendulum's stud and a boss for the key."""
    body = frustum(foot, head, 0, tall)
    body -= frustum(foot - 2 * wall, head - 2 * wall, -0.001, tall - wall)
    boss, stud = Pos(0, 0, key_z) * along_x(9, foot / 4, key_x), Pos(0, -foot / 4, pivot_z) * FRONT * Cylinder(6, -pivot_y - foot / 4 - rod_thick / 2 - 1, align=UP)
    body += boss + stud
    body += Pos(0, -foot / 4, pivot_z) * FRONT * Cylinder(stud_d / 2, -pivot_y - foot / 4 + 4, align=UP)
    return body - Pos(0, 0, key_z) * along_x(key_d / 2 + play, 1, 2 * key_x)


def pendulum(rod_wide, rod_thick, rod_high, stud_d, play, low=26, bob=11):
    """About its pivot: a flat rod upwards, a bob below."""
    flat = Pos(0, (rod_high - low) / 2) * Rectangle(rod_wide, rod_high + low) + Circle(8) + Pos(0, -low) * Circle(bob)
    body = FRONT * extrude(flat, rod_thick / 2, both=True)
    return body - FRONT * Cylinder(stud_d / 2 + play, 40)


def weight(rod_wide, rod_thick, play, wide=24, high=20, deep=10):
    """A block on the rod, its lower face at z = 0."""
    block = Box(wide, deep, high, align=UP)
    block = chamfer(block.edges().filter_by(Axis.Y).group_by(Axis.Z)[0], 5)
    return block - Box(rod_wide + 2 * play, rod_thick + 2 * play, 3 * high)


def key(key_d, shank=24, out=14, wing=10, thick=4):
    """Shank along x into the case, two wings outside."""
    body = along_x(key_d / 2, -shank, out + wing)
    flat = Pos(out + wing / 2, wing) * Circle(wing) + Pos(out + wing / 2, -wing) * Circle(wing)
    return body + FRONT * extrude(flat, thick / 2, both=True)
