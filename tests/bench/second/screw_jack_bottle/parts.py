from build123d import Align, Cone, Cylinder, Pos, Rot

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def base(foot_d, crown_d, tall, spindle_d, play, bed):
    return Cone(foot_d / 2, crown_d / 2, tall, align=UP) - Pos(Z=bed) * Cylinder(spindle_d / 2 + play, tall, align=UP)


def spindle(spindle_d, head_z, bed, head, neck_d, neck, head_d=47, hole_d=12):
    """Shank below the origin, head above it with a hole for a bar, neck for the saddle."""
    body = Cylinder(spindle_d / 2, head_z - bed - 3, align=DOWN) + Cylinder(head_d / 2, head, align=UP)
    body += Pos(Z=head) * Cylinder(neck_d / 2, neck, align=UP)
    return body - Pos(Z=head / 2) * Rot(Y=90) * Cylinder(hole_d / 2, 2 * head_d)


def saddle(saddle_d, closed, head_z, head, neck_d, neck, gap=0.1, free=0.25):
    """Plate with a blind hole for the neck; the origin is the neck's foot."""
    high = closed - head_z - head
    return Pos(Z=gap) * Cylinder(saddle_d / 2, high - gap, align=UP) - Cylinder(neck_d / 2 + free, neck + 0.5, align=UP)
