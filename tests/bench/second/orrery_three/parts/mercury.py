from build123d import Align, Box, Circle, Cylinder, Pos, Sphere, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def mercury(mercury_r, mercury_z, level, hub, bore_m, play, post_d, ball_d=7, bar=4):
    """An arm with a hub, a post and a ball, in one piece."""
    body = extrude(Circle(bore_m / 2 + 4), hub) + Pos(mercury_r / 2, 0, 2) * Box(mercury_r, post_d, bar, align=UP)
    body += Pos(mercury_r, 0, 2) * Cylinder(post_d / 2, level - mercury_z - 2, align=UP)
    return body + Pos(mercury_r, 0, level - mercury_z) * Sphere(ball_d / 2) - Cylinder(bore_m / 2 + play, 3 * hub)
