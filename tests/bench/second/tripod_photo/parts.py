from build123d import Align, Axis, Box, Cylinder, Pos, Rot, Sphere, chamfer

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)
ACROSS = Rot(90, 0, 0)


def hub(hip_z, hip_r, hub, hub_low, hub_high, fork, fork_half, gap, cheek, pin, column, play):
    """A round hub with three forks; each has a pin across."""
    body = Pos(0, 0, hub_low - hip_z) * Cylinder(hub / 2, hub_high - hub_low, align=UP)
    inner = hub / 2 - 4
    for turn in (0, 120, 240):
        for y in (-1, 1):
            side = Pos((inner + hip_r + fork) / 2, y * (gap + cheek) / 2, 0)
            body += Rot(0, 0, turn) * side * Box(hip_r + fork - inner, cheek, 2 * fork_half)
        body += Rot(0, 0, turn) * Pos(hip_r, 0, 0) * ACROSS * Cylinder(pin / 2, gap + cheek)
    return body - Cylinder(column / 2 + play, 3 * hip_z)


def leg(azimuth_deg, spread_deg, tube, tube_long, shank, inside, pin, play):
    """A tube that hangs down from its eye at the origin; bored from below for the foot section."""
    body = Pos(0, 0, -tube_long) * Cylinder(tube / 2, tube_long + 7, align=UP)
    body = chamfer(body.edges().sort_by(Axis.Z)[-1], 5)
    body -= ACROSS * Cylinder(pin / 2 + play, 2 * tube) + Pos(0, 0, -tube_long) * Cylinder(shank / 2 + play, inside + 2, align=UP)
    return Rot(0, 0, azimuth_deg) * Rot(0, -spread_deg, 0) * body


def foot(azimuth_deg, spread_deg, tube_long, foot_long, foot, shank, inside):
    """The shank goes up into the leg, the foot ends below."""
    out = foot_long - tube_long
    body = Pos(0, 0, -out) * Cylinder(shank / 2, out + inside, align=UP) + Pos(0, 0, -out) * Cylinder(foot / 2, 22, align=UP)
    return Rot(0, 0, azimuth_deg) * Rot(0, -spread_deg, 0) * body


def column(ball_z, ball, neck, column, column_low, column_top):
    """Its origin is the middle of the ball."""
    body = Pos(0, 0, column_low - ball_z) * Cylinder(column / 2, column_top - column_low, align=UP)
    body = chamfer(body.edges().sort_by(Axis.Z)[-1], 2)
    return body + Sphere(ball / 2) + Cylinder(neck / 2, ball_z - column_top + 5, align=DOWN)


def head(ball_z, ball, ball_play, head_d, head_low, head_top, top_z, table):
    body = Pos(0, 0, head_low - ball_z) * Cylinder(head_d / 2, head_top - head_low + 1, align=UP)
    body += Pos(0, 0, head_top - ball_z) * Box(table, table, top_z - head_top, align=UP)
    return body - Sphere(ball / 2 + ball_play)
