from build123d import Align, Box, Circle, Cylinder, Pos, Sphere, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def venus(venus_r, venus_z, level, hub, bore_v, play, post_d, ball_d=10, bar=4):
    """An arm with a hub, a post and a ball, in one piece."""
    body = extrude(Circle(bore_v / 2 + 4), hub) + Pos(venus_r / 2, 0, 2) * Box(venus_r, post_d, bar, align=UP)
    body += Pos(venus_r, 0, 2) * Cylinder(post_d / 2, level - venus_z - 2, align=UP)
    return body + Pos(venus_r, 0, level - venus_z) * Sphere(ball_d / 2) - Cylinder(bore_v / 2 + play, 3 * hub)
